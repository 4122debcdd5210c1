//! The packages that a program needs to use a structure, and the commands that add them.

use std::path::{Path, PathBuf};

use sixfold::{Representation, for_each_representation};

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

/// Returns a sentence with the types and the commands that add their packages. `packages` are the
/// packages of the types, and `checkout` is a repository of Sixfold.
pub(crate) fn how_to_use(types: &[String], packages: &[String], checkout: Option<&Path>) -> String {
    let types: Vec<String> = types.iter().map(|path| format!("`{path}`")).collect();
    let types = types.join(" and ");
    let (ours, others): (Vec<&String>, Vec<_>) = packages.iter().partition(|p| is_ours(p));
    let mut steps: Vec<String> = Vec::new();
    if !others.is_empty() {
        let names: Vec<String> = others.iter().map(|name| format!("`{name}`")).collect();
        let packages = if names.len() == 1 {
            "the package"
        } else {
            "the packages"
        };
        let names = names.join(" and ");
        steps.push(format!(
            "add {packages} {names}, not part of Sixfold, to its dependencies"
        ));
    }
    if !ours.is_empty() {
        let commands: Vec<String> = ours.iter().map(|p| command(p, checkout)).collect();
        steps.push(format!("run {}", commands.join(" and ")));
    }
    let steps = steps.join(" and ");
    let note = match checkout {
        None if !ours.is_empty() => {
            " If cargo does not find a package, add `--path` and the folder of the package in the \
             repository of Sixfold."
        }
        _ => "",
    };
    format!("To use {types} in your package, {steps}.{note}")
}

/// Returns the command that adds a package of Sixfold.
fn command(package: &str, checkout: Option<&Path>) -> String {
    let folder = package.strip_prefix("sixfold-").unwrap_or(package);
    let path = checkout.map(|checkout| checkout.join("crates").join(folder));
    match path.filter(|path| path.join("Cargo.toml").is_file()) {
        Some(path) => format!("`cargo add {package} --path {}`", quoted(&path)),
        None => format!("`cargo add {package}`"),
    }
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

/// Returns whether a structure of Sixfold, or the relation tables, are in this package.
fn is_ours(package: &str) -> bool {
    let mut ours = package == "sixfold-relation-table";
    for_each_representation!(M => {
        let path = M::type_path();
        let name = path.split_once("::").map_or(path, |(name, _)| name);
        ours |= name.replace('_', "-") == package;
    });
    ours
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(texts: &[&str]) -> Vec<String> {
        texts.iter().map(|&text| text.into()).collect()
    }

    #[test]
    fn the_command_names_a_folder_of_the_checkout() {
        let checkout = checkout().expect("the tests run in a checkout");
        let types = texts(&["sixfold_half_edge::HalfEdgeMesh"]);
        let sentence = how_to_use(&types, &texts(&["sixfold-half-edge"]), Some(&checkout));
        let (_, path) = sentence.split_once("--path ").expect("a path");
        let path = path.strip_suffix("`.").expect("the end of the command");
        let path = path.trim_matches('\'');
        assert!(Path::new(path).join("src/lib.rs").is_file(), "{sentence}");
        assert_eq!(checkout_at(&checkout.join("crates")), None);
    }

    #[test]
    fn without_a_checkout_the_command_has_no_path_and_a_note() {
        let packages = texts(&["sixfold-corner-table", "sixfold-relation-table"]);
        let sentence = how_to_use(&texts(&["a::A", "b::B"]), &packages, None);
        let expected = "To use `a::A` and `b::B` in your package, run `cargo add \
             sixfold-corner-table` and `cargo add sixfold-relation-table`. If cargo does not find a \
             package, add `--path` and the folder of the package in the repository of Sixfold.";
        assert_eq!(sentence, expected);
    }

    #[test]
    fn the_package_of_another_structure_gets_no_path() {
        let checkout = checkout();
        for package in ["mine", "sixfold-octree"] {
            let packages = texts(&[package]);
            let sentence = how_to_use(&texts(&["mine::Mesh"]), &packages, checkout.as_deref());
            let expected = format!(
                "To use `mine::Mesh` in your package, add the package `{package}`, not part of \
                 Sixfold, to its dependencies."
            );
            assert_eq!(sentence, expected);
        }
    }

    #[test]
    fn a_path_with_a_space_is_quoted() {
        assert_eq!(quoted(Path::new("/my code/it's")), r"'/my code/it'\''s'");
        assert_eq!(quoted(Path::new("/work/a-b_c.d")), "/work/a-b_c.d");
    }
}
