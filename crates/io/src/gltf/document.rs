//! The part of the JSON text that describes meshes.

use std::collections::BTreeMap;
use std::fmt;

use base64::Engine;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use serde::de::{IgnoredAny, Visitor};
use serde::{Deserialize, Deserializer};

use crate::builder::MeshBuilder;
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::place::Place;

/// Base64 with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// The top of the document.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Document {
    asset: Asset,
    pub(super) scene: Option<usize>,
    #[serde(default)]
    pub(super) scenes: Vec<Scene>,
    #[serde(default)]
    pub(super) nodes: Vec<Node>,
    #[serde(default)]
    pub(super) meshes: Vec<Mesh>,
    #[serde(default)]
    pub(super) accessors: Vec<Accessor>,
    #[serde(default)]
    pub(super) buffer_views: Vec<BufferView>,
    #[serde(default)]
    pub(super) buffers: Vec<Buffer>,
    #[serde(default)]
    pub(super) animations: Vec<IgnoredAny>,
    #[serde(default)]
    pub(super) skins: Vec<IgnoredAny>,
    #[serde(default)]
    pub(super) extensions_used: Vec<String>,
    #[serde(default)]
    pub(super) extensions_required: Vec<String>,
}

#[derive(Deserialize)]
struct Asset {
    version: String,
}

#[derive(Deserialize)]
pub(super) struct Scene {
    #[serde(default)]
    pub(super) nodes: Vec<usize>,
}

/// A node: a mesh at a place, and further nodes relative to it.
#[derive(Deserialize)]
pub(super) struct Node {
    #[serde(default)]
    pub(super) children: Vec<usize>,
    pub(super) mesh: Option<usize>,
    pub(super) skin: Option<usize>,
    /// By columns.
    pub(super) matrix: Option<[f64; 16]>,
    pub(super) translation: Option<[f64; 3]>,
    /// A unit quaternion x, y, z, w.
    pub(super) rotation: Option<[f64; 4]>,
    pub(super) scale: Option<[f64; 3]>,
    /// The weights of the morph targets of the mesh, in the place of those of the mesh.
    pub(super) weights: Option<Vec<f64>>,
    #[serde(default)]
    pub(super) extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize)]
pub(super) struct Mesh {
    #[serde(default)]
    pub(super) primitives: Vec<Primitive>,
    /// The weights of the morph targets of each primitive; 0 if they are missing.
    #[serde(default)]
    pub(super) weights: Vec<f64>,
}

/// A list of triangles, points or lines.
#[derive(Deserialize)]
pub(super) struct Primitive {
    /// The accessors with the data of vertices.
    #[serde(default)]
    pub(super) attributes: BTreeMap<String, usize>,
    pub(super) indices: Option<usize>,
    #[serde(default = "triangles")]
    pub(super) mode: u32,
    pub(super) material: Option<usize>,
    /// Morph targets: the accessors with what is added to the data of vertices, times a weight.
    #[serde(default)]
    pub(super) targets: Vec<BTreeMap<String, usize>>,
    #[serde(default)]
    pub(super) extensions: BTreeMap<String, IgnoredAny>,
}

impl Primitive {
    /// Returns the accessors of the positions and the indices.
    pub(super) fn accessors(&self) -> impl Iterator<Item = usize> {
        let position = self.attributes.get("POSITION").copied();
        position.into_iter().chain(self.indices)
    }
}

fn triangles() -> u32 {
    4
}

/// A typed view of a part of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Accessor {
    pub(super) buffer_view: Option<usize>,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
    #[serde(default)]
    pub(super) normalized: bool,
    pub(super) count: u64,
    #[serde(rename = "type")]
    pub(super) kind: String,
    pub(super) sparse: Option<Sparse>,
}

impl Accessor {
    /// Returns the buffer views of all data of the accessor.
    pub(super) fn views(&self) -> impl Iterator<Item = usize> {
        let sparse = self.sparse.as_ref();
        let sparse = sparse.map(|sparse| [sparse.indices.buffer_view, sparse.values.buffer_view]);
        self.buffer_view
            .into_iter()
            .chain(sparse.into_iter().flatten())
    }
}

/// Replacements of some elements of an accessor.
#[derive(Deserialize)]
pub(super) struct Sparse {
    pub(super) count: u64,
    pub(super) indices: SparseIndices,
    pub(super) values: SparseValues,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseIndices {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) component_type: u32,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct SparseValues {
    pub(super) buffer_view: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
}

/// A part of a buffer.
#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct BufferView {
    pub(super) buffer: usize,
    #[serde(default)]
    pub(super) byte_offset: u64,
    pub(super) byte_length: u64,
    pub(super) byte_stride: Option<u64>,
    #[serde(default)]
    pub(super) extensions: BTreeMap<String, IgnoredAny>,
}

#[derive(Deserialize)]
#[serde(rename_all = "camelCase")]
pub(super) struct Buffer {
    pub(super) uri: Option<Uri>,
    pub(super) byte_length: u64,
}

/// The place of the data of a buffer.
pub(super) enum Uri {
    /// The data itself, decoded at once so that its text need not be kept; `None` if the text is
    /// invalid.
    Embedded(Option<Vec<u8>>),
    /// Another file.
    File(String),
}

impl<'de> Deserialize<'de> for Uri {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Text;
        impl Visitor<'_> for Text {
            type Value = Uri;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a URI")
            }

            fn visit_str<E>(self, uri: &str) -> Result<Uri, E> {
                Ok(match uri.strip_prefix("data:") {
                    Some(data) => Uri::Embedded(decode(data)),
                    None => Uri::File(uri.to_owned()),
                })
            }
        }
        deserializer.deserialize_str(Text)
    }
}

/// Decodes what follows `data:` in a URI; `None` if it is not base64 text.
pub(super) fn decode(data: &str) -> Option<Vec<u8>> {
    let (_, encoded) = data.split_once(";base64,")?;
    BASE64.decode(encoded.trim()).ok()
}

/// Returns `message` without the middle of long values that it quotes.
fn shown(message: &str) -> String {
    const MAX_CHARS: usize = 80;
    let chars: Vec<char> = message.chars().collect();
    if chars.len() <= 2 * MAX_CHARS {
        return message.to_owned();
    }
    let (start, end) = (&chars[..MAX_CHARS], &chars[chars.len() - MAX_CHARS..]);
    format!("{}…{}", String::from_iter(start), String::from_iter(end))
}

impl Document {
    /// Returns the accessors that are read if all meshes are: of positions, of indices, and of the morph
    /// targets of meshes for which there is a weight that is not 0.
    pub(super) fn accessors(&self) -> Vec<usize> {
        let applies = |weights: &[f64]| weights.iter().any(|&weight| weight != 0.0);
        let mut morphs: Vec<bool> = self
            .meshes
            .iter()
            .map(|mesh| applies(&mesh.weights))
            .collect();
        for node in &self.nodes {
            let mesh = node.mesh.and_then(|mesh| morphs.get_mut(mesh));
            if let (Some(morphs), Some(weights)) = (mesh, &node.weights) {
                *morphs |= applies(weights);
            }
        }
        let mut accessors = Vec::new();
        for (mesh, morphs) in self.meshes.iter().zip(morphs) {
            for primitive in &mesh.primitives {
                accessors.extend(primitive.accessors());
                let targets = primitive.targets.iter().filter(|_| morphs);
                accessors.extend(targets.filter_map(|target| target.get("POSITION")));
            }
        }
        accessors
    }

    /// Parses the JSON text.
    pub(super) fn parse(json: &[u8], builder: &MeshBuilder) -> Result<Self, ReadError> {
        let json = json.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(json);
        let document = serde_json::from_slice::<Self>(json).map_err(|cause| {
            let line = u32::try_from(cause.line()).unwrap_or(u32::MAX);
            let at = builder.at(Place::Line(line.max(1)));
            let message = shown(&cause.to_string());
            let fault = GltfFault::Json { message };
            ReadError::Gltf { at, fault }
        })?;
        if document.asset.version.split('.').next() == Some("2") {
            return Ok(document);
        }
        let version = crate::excerpt::shortened(&document.asset.version);
        let fault = GltfFault::Version { version };
        let at = builder.at(Place::Line(1));
        Err(ReadError::Gltf { at, fault })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn embedded_data_is_decoded() {
        let mime = "application/octet-stream;base64,";
        assert_eq!(decode(&format!("{mime}AAEC")), Some(vec![0, 1, 2]));
        assert_eq!(decode(&format!("{mime}AA==")), Some(vec![0]));
        assert_eq!(decode(&format!("{mime}AA")), Some(vec![0]));
        assert_eq!(decode(&format!("{mime}A*")), None);
        assert_eq!(decode(",abc"), None);
    }
}
