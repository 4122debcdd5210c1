//! `sixfold new`: writes a package that measures a program of a user.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::{env, fs};

use crate::arguments::New;
use crate::failure::Failure;
use crate::text::TextOutput;

/// The files of the package. `NAME` stands for its name, and `CHECKOUT` for the path of Sixfold.
const FILES: [(&str, &str); 4] = [
    ("Cargo.toml", include_str!("../templates/new/manifest.toml")),
    ("README.md", include_str!("../templates/new/README.md")),
    (
        ".cargo/config.toml",
        include_str!("../templates/new/config.toml"),
    ),
    (".gitignore", "/target\n"),
];

/// The program of the package: one that queries the mesh, and one that edits it.
const QUERIES: &str = include_str!("../templates/new/main.rs");
const EDITS: &str = include_str!("../templates/new/edits.rs");

pub(crate) fn run(arguments: &New) -> Result<ExitCode, Failure> {
    let folder = &arguments.folder;
    let shown = folder.display();
    let name = folder.file_name().map(|name| name.to_string_lossy());
    let name = name.as_deref().unwrap_or_default();
    if !is_package_name(name) {
        return Err(Failure::usage(format!(
            "{shown}: the last part must be a package name: letters, digits, - and _, and a letter \
             first"
        )));
    }
    let checkout = checkout(arguments.checkout.as_deref())?;
    let cannot = |error: std::io::Error| Failure::usage(format!("{shown}: {error}"));
    if folder.exists() && fs::read_dir(folder).map_err(cannot)?.next().is_some() {
        return Err(Failure::usage(format!(
            "{shown}: the folder is not empty: name a new folder"
        )));
    }
    let program = match arguments.edits {
        true => EDITS,
        false => QUERIES,
    };
    for (path, content) in FILES.into_iter().chain([("src/main.rs", program)]) {
        let path = folder.join(path);
        let content = content.replace("NAME", name).replace("CHECKOUT", &checkout);
        let parent = path.parent().unwrap_or(folder);
        fs::create_dir_all(parent).map_err(cannot)?;
        fs::write(&path, content).map_err(cannot)?;
    }
    let mut text = TextOutput::new(true);
    text.print_line(&format!("Wrote the package {name}. Next:"));
    text.print_line(&format!(
        "  cd {shown} && cargo run --release -- --budget 10s"
    ));
    text.finish()?;
    Ok(ExitCode::SUCCESS)
}

/// Returns the path of the repository as a text between quotes in TOML: the given folder, else the folder in which
/// the command runs or one above it, or a folder `sixfold` in one of them.
fn checkout(given: Option<&Path>) -> Result<String, Failure> {
    let above = || {
        let here = env::current_dir().ok()?;
        let places = here.ancestors();
        places
            .flat_map(|place| [place.to_owned(), place.join("sixfold")])
            .find_map(|place| checkout_at(&place))
    };
    let found = match given {
        Some(folder) => checkout_at(folder),
        None => above(),
    };
    let found = found.ok_or_else(|| {
        let place = given.map_or("the current folder or above it".into(), |folder| {
            folder.display().to_string()
        });
        Failure::usage(format!(
            "no Sixfold repository is in {place}: name its folder with --checkout"
        ))
    })?;
    let text = found.to_string_lossy();
    Ok(text.replace('\\', "\\\\").replace('"', "\\\""))
}

/// Returns the absolute path of `folder` if it is a repository of Sixfold.
fn checkout_at(folder: &Path) -> Option<PathBuf> {
    let found = folder.canonicalize().ok()?;
    let measure = found.join("crates/measure/Cargo.toml");
    measure.is_file().then_some(found)
}

fn is_package_name(name: &str) -> bool {
    let fine = |c: char| c.is_ascii_alphanumeric() || matches!(c, '-' | '_');
    name.starts_with(|c: char| c.is_ascii_alphabetic()) && name.chars().all(fine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_packages_start_with_a_letter() {
        for name in ["mine", "my-program", "a1_b"] {
            assert!(is_package_name(name), "{name}");
        }
        for name in ["", "1a", "-a", "a b", "ä", "a.b"] {
            assert!(!is_package_name(name), "{name}");
        }
    }
}
