//! What the explorer shows, as data: the state that its links and files hold (`state.js`).

use std::fs;
use std::path::Path;

use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use clap::Parser;
use serde::Serialize;
use serde_json::{Map, Value, json};
use sixfold_explain::respond;

use crate::arguments::relation;
use crate::arguments::{Arguments, Command, Explained, Trace};
use crate::failure::Failure;
use crate::text::sanitize;

/// The version of the format.
const VERSION: u32 = 1;

/// Maximum number of bytes of a mesh in a lesson.
const MOST_BYTES: usize = 16_000;

/// What the explorer shows.
#[derive(Clone, Debug, Serialize)]
pub(crate) struct Situation {
    sixfold: u32,
    /// The fields of a request that name the mesh.
    subject: Map<String, Value>,
    name: String,
    edits: Vec<String>,
    /// What is shown of the mesh. The page has a default for each missing field.
    view: Map<String, Value>,
}

impl Default for Situation {
    fn default() -> Self {
        Self::new("octahedron", json!({ "shape": { "name": "octahedron" } }))
    }
}

impl Situation {
    fn new(name: &str, mesh: Value) -> Self {
        Self {
            sixfold: VERSION,
            subject: Map::from_iter([("mesh".to_owned(), mesh)]),
            name: name.to_owned(),
            edits: Vec::new(),
            view: Map::new(),
        }
    }

    /// Shows the mesh in a file.
    ///
    /// # Errors
    ///
    /// Returns an error if the file cannot be read, or if the page would refuse it.
    pub(crate) fn of_file(path: &Path) -> Result<Self, Failure> {
        let shown = sanitize(&path.display().to_string());
        let bytes = fs::read(path)
            .map_err(|cause| Failure::usage(format!("cannot read {shown}: {cause}")))?;
        let situation = Self::of_content(path, bytes);
        situation.check()?;
        Ok(situation)
    }

    /// Shows the mesh in the content of a file.
    fn of_content(path: &Path, bytes: Vec<u8>) -> Self {
        let name = path.file_name().unwrap_or(path.as_os_str());
        let name = name.to_string_lossy();
        let content = match String::from_utf8(bytes) {
            Ok(text) if !text.contains('\0') => ("text".to_owned(), text),
            Ok(text) => ("base64".to_owned(), STANDARD.encode(text)),
            Err(error) => ("base64".to_owned(), STANDARD.encode(error.as_bytes())),
        };
        let mut file = Map::from_iter([("name".to_owned(), json!(name))]);
        file.insert(content.0, json!(content.1));
        Self::new(&name, json!({ "file": file }))
    }

    /// Returns the error that the page would show instead of the mesh.
    fn check(&self) -> Result<(), Failure> {
        let mut request = self.subject.clone();
        request.insert("ask".to_owned(), json!("facts"));
        let response = respond(&Value::Object(request).to_string());
        let response: Value = serde_json::from_str(&response).unwrap_or_default();
        match response["error"].as_str() {
            Some(error) => Err(Failure::usage(error)),
            None => Ok(()),
        }
    }

    /// Opens a lesson beside the mesh.
    pub(crate) fn open_lesson(&mut self, name: &str) {
        self.show("lesson", name);
    }

    fn show(&mut self, field: &str, value: impl Into<Value>) {
        self.view.insert(field.to_owned(), value.into());
    }

    /// Returns what the explorer shows instead of the output of a command. `folder` has the files that the command
    /// reads. `None` if the explorer does not show it, or if the mesh is too large to be a part of each page.
    pub(crate) fn of_command(line: &str, folder: &Path) -> Option<Self> {
        let words = shlex::split(line)?;
        let command = Arguments::try_parse_from(words).ok()?.command?;
        let situation = match command {
            Command::Trace(trace) => Self::of_trace(&trace, folder),
            Command::Tables(tables) => {
                let mut situation = Self::of_mesh(tables.mesh.as_deref(), folder)?;
                situation.explain(&tables.explained);
                Some(situation)
            }
            Command::Inspect(inspect) => match &inspect.meshes[..] {
                [mesh] => Self::of_mesh(Some(mesh), folder).map(|situation| situation.tab("check")),
                _ => None,
            },
            Command::Repair(repair) => {
                let situation = Self::of_mesh(Some(&repair.files.mesh), folder)?;
                Some(situation.tab("check"))
            }
            Command::Subdivide(subdivide) => {
                let situation = Self::of_mesh(Some(&subdivide.files.mesh), folder)?;
                let mut situation = situation.tab("subdivide");
                situation.show("scheme", subdivide.scheme.name());
                situation.show("level", subdivide.levels);
                if let Some(creases) = &subdivide.creases {
                    let text = fs::read_to_string(folder.join(creases)).ok()?;
                    situation.subject.insert("creases".to_owned(), json!(text));
                }
                Some(situation)
            }
            _ => None,
        }?;
        situation.check().ok()?;
        Some(situation)
    }

    fn tab(mut self, tab: &str) -> Self {
        self.show("tab", tab);
        self
    }

    /// Shows the mesh of a command: a file in `folder`, or a cube if the command names none.
    fn of_mesh(mesh: Option<&Path>, folder: &Path) -> Option<Self> {
        let Some(mesh) = mesh else {
            return Some(Self::new("cube", json!({ "shape": { "name": "cube" } })));
        };
        let bytes = fs::read(folder.join(mesh)).ok()?;
        (bytes.len() <= MOST_BYTES).then(|| Self::of_content(mesh, bytes))
    }

    fn of_trace(trace: &Trace, folder: &Path) -> Option<Self> {
        let words: Vec<&str> = trace
            .query
            .iter()
            .filter_map(|word| word.to_str())
            .collect();
        let (mesh, query) = match words[..] {
            [] => (None, None),
            [mesh] => (Some(mesh), None),
            [relation, element] => (None, Some((relation, element))),
            [mesh, relation, element, ..] => (Some(mesh), Some((relation, element))),
        };
        let mut situation = Self::of_mesh(mesh.map(Path::new), folder)?;
        situation.explain(&trace.explained);
        situation.edits.clone_from(&trace.edit);
        let last = trace.edit.last().and_then(|edit| edit.split(' ').nth(1));
        if let Some(element) = last.filter(|word| word.starts_with(['v', 'f'])) {
            situation.show("element", element);
        }
        let expected = trace
            .expect
            .as_deref()
            .and_then(|text| text.split_once(' '));
        if let Some((relation_name, element)) = query.or(expected) {
            situation.show("relation", relation(relation_name).ok()?.name());
            situation.show("element", element);
        }
        if let Some(walk) = &trace.walk {
            situation.show("walk", walk.as_str());
        }
        let tab = match (query, &trace.walk) {
            (Some(_), _) => "query",
            (None, Some(_)) => "walk",
            (None, None) => "edit",
        };
        Some(situation.tab(tab))
    }

    /// Shows the first of the selected structures in front, and cuts polygons if the command does.
    fn explain(&mut self, explained: &Explained) {
        if explained.triangulate {
            self.subject.insert("triangulate".to_owned(), json!(true));
        }
        if let Some(first) = explained.backend.first() {
            self.show("focus", first.as_str());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(line: &str) -> Value {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(
            folder.path().join("square.obj"),
            "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n",
        )
        .expect("a file");
        fs::write(folder.path().join("sharp.txt"), "edge 0 1 2\n").expect("a file");
        let situation = Situation::of_command(line, folder.path());
        serde_json::to_value(situation).expect("JSON")
    }

    #[test]
    fn commands_become_situations() {
        let trace = shown(
            "sixfold trace square.obj VV v0 --backend corner-table,half-edge --edit \"poke_face f0\"",
        );
        assert_eq!(trace["subject"]["mesh"]["file"]["name"], "square.obj");
        assert_eq!(trace["edits"], json!(["poke_face f0"]));
        let view = json!({ "tab": "query", "relation": "vertex_vertices", "element": "v0", "focus": "corner-table" });
        assert_eq!(trace["view"], view);
        let edit = shown("sixfold trace --triangulate --all --edit \"flip_edge v0-v2\"");
        assert_eq!(edit["subject"]["triangulate"], true);
        assert_eq!(
            (&edit["view"]["tab"], &edit["view"]["element"]),
            (&json!("edit"), &json!("v0-v2"))
        );
        let walk = shown("sixfold trace --walk \"yield v0\" --expect \"VV v1\"");
        assert_eq!(
            (&walk["view"]["tab"], &walk["view"]["element"]),
            (&json!("walk"), &json!("v1"))
        );
        let levels =
            shown("sixfold subdivide square.obj --scheme loop --levels 2 --creases sharp.txt -o -");
        assert_eq!(levels["subject"]["creases"], "edge 0 1 2\n");
        assert_eq!(
            (&levels["view"]["scheme"], &levels["view"]["level"]),
            (&json!("loop"), &json!(2))
        );
        let fault = shown("sixfold inspect square.obj");
        assert_eq!(fault["view"]["tab"], "check");
        for line in [
            "sixfold why square.obj",
            "sixfold tables missing.obj",
            "sixfold frobnicate",
        ] {
            assert_eq!(shown(line), Value::Null, "{line}");
        }
    }

    #[test]
    fn files_that_are_not_text_are_base64() {
        let binary = Situation::of_content(Path::new("a/b.stl"), vec![0xff, 0]);
        assert_eq!(
            binary.subject["mesh"],
            json!({ "file": { "name": "b.stl", "base64": "/wA=" } })
        );
        let error = binary.check().expect_err("no mesh");
        assert!(error.message.contains("b.stl"), "{}", error.message);
    }
}
