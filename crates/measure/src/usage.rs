//! How a program uses what `pick` chose: the command that adds the package, and lines of Rust.

use sixfold::io::Format;
use sixfold::{Relation, Representation, for_each_representation};

/// Maximum number of columns of a line of Rust.
const WIDTH: usize = 76;
/// The file that is read if the mesh was no file.
const SOME_FILE: &str = "mesh.obj";
/// The command that adds the package.
const ADD: &str = "cargo add sixfold --path CHECKOUT/crates/sixfold   # CHECKOUT: your clone";

/// Returns the command that adds the package, then lines of Rust that read the file `mesh` into a backend
/// with these types and tables of relations. Empty if the type of the backend is not known.
pub(crate) fn lines(types: &[String], tabulated: &[String], mesh: &str) -> Vec<String> {
    let Some((path, package, name)) = types.first().and_then(|path| split(path)) else {
        return Vec::new();
    };
    let ours = is_ours(package);
    let mut lines = vec![ADD.to_owned()];
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
            let lines = lines(&types, tabulated, "built-in mesh");
            assert_eq!(lines[0], ADD);
            let code: Vec<&str> = lines[1..].iter().map(|line| line.trim()).collect();
            let found = compiled.windows(code.len()).any(|window| window == code);
            assert!(found, "{}", lines.join("\n"));
            assert!(
                lines[1..].iter().all(|line| line.len() <= WIDTH),
                "{lines:?}"
            );
        }
        assert_eq!(lines(&[], &[], "a.ply"), [""; 0]);
        let named = lines(&known[..1], &[], "a \"b\".ply");
        assert!(
            named[2].ends_with(r#"io::load("a \"b\".ply")?;"#),
            "{named:?}"
        );
    }
}
