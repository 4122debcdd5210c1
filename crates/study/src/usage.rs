//! How a program uses what `pick` chose: the command that adds the package, and lines of Rust.

use std::path::{Path, PathBuf};

use sixfold::io::Format;
use sixfold::{Relation, Representation, for_each_representation};

/// Maximum number of columns of a line of Rust.
const WIDTH: usize = 76;
/// The file that is read if the mesh was no file.
const SOME_FILE: &str = "mesh.obj";

/// Returns the repository of Sixfold from which this program was built. Returns `None` if the folder
/// does not exist any more.
pub fn checkout() -> Option<PathBuf> {
    checkout_at(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../.."))
}

/// Returns the absolute path of `folder` if it is a repository of Sixfold.
pub fn checkout_at(folder: &Path) -> Option<PathBuf> {
    let found = folder.canonicalize().ok()?;
    let cli = found.join("crates/sixfold-cli/Cargo.toml");
    cli.is_file().then_some(found)
}

/// Returns the command that adds the package, then lines of Rust that read the file `mesh` into a backend
/// with these types and tables of relations. `checkout` is a repository of Sixfold. Empty if the type of the backend
/// is not known.
pub(crate) fn lines(
    types: &[String],
    tabulated: &[String],
    mesh: &str,
    checkout: Option<&Path>,
) -> Vec<String> {
    let Some((path, package, name)) = types.first().and_then(|path| split(path)) else {
        return Vec::new();
    };
    let ours = is_ours(package);
    let from = checkout.map_or(String::new(), |checkout| {
        format!(" --path {}", quoted(&checkout.join("crates/sixfold")))
    });
    let mut lines = vec![format!("cargo add sixfold{from}")];
    let relations: Vec<Relation> = tabulated
        .iter()
        .filter_map(|name| name.parse().ok())
        .collect();
    let mut imports = Vec::new();
    match ours {
        true => imports.push(name),
        false => lines.push(format!("use {path};")),
    }
    if !relations.is_empty() {
        imports.extend(["Relation", "RelationTables"]);
    }
    imports.push("io");
    lines.push(match &imports[..] {
        [only] => format!("use sixfold::{only};"),
        several => format!("use sixfold::{{{}}};", several.join(", ")),
    });
    let file = match Format::from_path(mesh) {
        Some(_) => mesh,
        None => SOME_FILE,
    };
    let mutable = if name.starts_with("Editable") {
        "mut "
    } else {
        ""
    };
    lines.push(format!("let {mutable}mesh: {name} = io::load({file:?})?;"));
    if !relations.is_empty() {
        let list: Vec<String> = relations
            .iter()
            .map(|r| format!("Relation::{r:?}"))
            .collect();
        let one_line = format!("let relations = [{}];", list.join(", "));
        match one_line.len() <= WIDTH {
            true => lines.push(one_line),
            false => {
                lines.push("let relations = [".into());
                lines.extend(list.iter().map(|relation| format!("    {relation},")));
                lines.push("];".into());
            }
        }
        lines.push("let tables = RelationTables::new(&mesh, &relations)?;".into());
    }
    lines
}

/// Returns the path of a type without its parameters, the crate, and the last name.
fn split(path: &str) -> Option<(&str, &str, &str)> {
    let (path, _) = path.split_once('<').unwrap_or((path, ""));
    let (package, rest) = path.split_once("::")?;
    Some((path, package, rest.rsplit("::").next()?))
}

/// Returns a path as one word for a shell.
fn quoted(path: &Path) -> String {
    let text = path.to_string_lossy();
    let is_plain = |c: char| c.is_alphanumeric() || "/._-+:\\".contains(c);
    match text.chars().all(is_plain) {
        true => text.into_owned(),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}

/// Returns whether a structure of Sixfold is in this crate.
fn is_ours(package: &str) -> bool {
    let mut ours = false;
    for_each_representation!(M => {
        ours |= split(M::type_path()).is_some_and(|(_, ours, _)| ours == package);
    });
    ours
}

#[cfg(test)]
mod tests {
    use sixfold::for_each_editable;

    use super::*;

    #[test]
    fn a_path_with_a_space_is_quoted() {
        assert_eq!(quoted(Path::new("/my code/it's")), r"'/my code/it'\''s'");
        assert_eq!(quoted(Path::new("/work/a-b_c.d")), "/work/a-b_c.d");
    }

    #[test]
    fn what_is_printed_compiles() {
        // A test that is compiled, so its lines compile.
        let compiled = include_str!("../tests/all/usage.rs");
        let compiled: Vec<&str> = compiled.lines().map(str::trim).collect();
        let mut known: Vec<String> = Vec::new();
        for_each_representation!(M => { known.push(M::type_path().into()); });
        for_each_editable!(M => { known.push(M::type_path().into()); });
        known.push("mine::inner::Mesh<mine::Editable>".into());
        let all = Relation::ALL.map(|relation| relation.name().to_owned());
        for (types, tabulated) in known
            .iter()
            .map(|path| (vec![path.clone()], &[][..]))
            .chain([&all[..1], &all[..2], &all[..]].map(|some| {
                let tables = "sixfold_relation_table::RelationTables".to_owned();
                (
                    vec!["sixfold_face_vertex::FaceVertexMesh".to_owned(), tables],
                    some,
                )
            }))
        {
            let lines = lines(&types, tabulated, "built-in mesh", None);
            assert_eq!(lines[0], "cargo add sixfold");
            let code: Vec<&str> = lines[1..].iter().map(|line| line.trim()).collect();
            let found = compiled.windows(code.len()).any(|window| window == code);
            assert!(found, "{}", lines.join("\n"));
            assert!(lines.iter().all(|line| line.len() <= WIDTH), "{lines:?}");
        }
        assert_eq!(lines(&[], &[], "a.ply", None), [""; 0]);
        let named = lines(&known[..1], &[], "a \"b\".ply", Some(Path::new("/a b")));
        assert_eq!(named[0], "cargo add sixfold --path '/a b/crates/sixfold'");
        assert!(
            named[2].ends_with(r#"io::load("a \"b\".ply")?;"#),
            "{named:?}"
        );
    }

    #[test]
    fn a_checkout_is_a_folder_with_the_command_line() {
        let checkout = checkout().expect("the tests run in a checkout");
        assert!(checkout.join("crates/sixfold/src/lib.rs").is_file());
        assert_eq!(checkout_at(&checkout.join("crates")), None);
    }
}
