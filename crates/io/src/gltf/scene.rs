//! Reads the meshes of a scene at their places.

mod triangles;

use std::collections::HashMap;

use sixfold_core::glam::{DMat4, DQuat, DVec3, DVec4};

use super::accessor::elements;
use super::buffers::Buffers;
use super::document::{Document, Node, Primitive};
use super::{fault, item};
use crate::builder::MeshBuilder;
use crate::error::ReadError;
use crate::faults::GltfFault;
use crate::notice::IgnoredKind;
use crate::number::Coordinate;
use crate::options::Scene;
use crate::place::Place;

/// How many times larger than the file a scene may be that repeats its meshes, in vertices, corners
/// and primitives per byte; and the size that is always allowed.
const MAX_GROWTH: u64 = 256;
const MAX_SMALL: u64 = 1 << 20;

/// The extension that repeats the mesh of a node.
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// How many vertices a primitive, and each of its attributes, counts as.
const PRIMITIVE_COST: u64 = 16;

/// Adds the meshes of a scene to a builder.
pub(super) struct SceneReader<'a, 'b> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    builder: &'a mut MeshBuilder<'b>,
    /// Number of vertices, corners and primitives that may be added.
    limit: u64,
    left: u64,
    /// Number of the scene, for messages.
    scene: usize,
    /// The meshes that the scene uses.
    used: Vec<bool>,
}

impl<'a, 'b> SceneReader<'a, 'b> {
    /// Creates a reader of a document of `bytes` bytes.
    pub(super) fn new(
        document: &'a Document,
        buffers: &'a Buffers<'a>,
        builder: &'a mut MeshBuilder<'b>,
        bytes: u64,
    ) -> Self {
        let bytes = bytes.saturating_add(buffers.bytes());
        let limit = bytes.saturating_mul(MAX_GROWTH).max(MAX_SMALL);
        Self {
            document,
            buffers,
            builder,
            limit,
            left: limit,
            scene: 0,
            used: vec![false; document.meshes.len()],
        }
    }

    /// Reads a scene, or all meshes if the file has neither scenes nor nodes.
    pub(super) fn read(&mut self, scene: Scene) -> Result<(), ReadError> {
        let document = self.document;
        let scenes = &document.scenes;
        let chosen = match scene {
            Scene::Number(number) => Some(number),
            Scene::Default => document.scene.or((!scenes.is_empty()).then_some(0)),
            Scene::All => None,
        };
        self.scene = chosen.unwrap_or(0);
        let roots = match chosen {
            None => self.nodes_without_parent(),
            Some(number) => {
                let chosen = scenes.get(number).ok_or_else(|| {
                    let count = scenes.len();
                    let missing = GltfFault::NoScene { count };
                    fault(self.buffers.name, "scene", number, missing)
                });
                chosen?.nodes.clone()
            }
        };
        self.read_nodes(roots)?;
        let unused = (0..document.meshes.len()).filter(|&mesh| !self.used[mesh]);
        let unused: Vec<usize> = unused.collect();
        let has_no_scene = scenes.is_empty() && document.nodes.is_empty();
        if scene == Scene::All || has_no_scene {
            for mesh in unused {
                self.read_mesh(mesh, DMat4::IDENTITY, None, ("mesh", mesh))?;
            }
        } else if let Some(&first) = unused.first() {
            self.note("mesh", first, IgnoredKind::UnusedMeshes, unused.len());
        }
        Ok(())
    }

    fn note(&mut self, kind: &'static str, number: usize, ignored: IgnoredKind, count: usize) {
        let place = Place::Item { kind, number };
        let notices = &mut self.builder.notices;
        notices.add_many(ignored, count as u64, place);
    }

    fn nodes_without_parent(&self) -> Vec<usize> {
        let nodes = &self.document.nodes;
        let mut is_root = vec![true; nodes.len()];
        for &child in nodes.iter().flat_map(|node| &node.children) {
            if let Some(is_root) = is_root.get_mut(child) {
                *is_root = false;
            }
        }
        (0..nodes.len()).filter(|&node| is_root[node]).collect()
    }

    /// Reads the meshes of the nodes below `roots`, in depth-first order.
    fn read_nodes(&mut self, roots: Vec<usize>) -> Result<(), ReadError> {
        let nodes = &self.document.nodes;
        let name = self.buffers.name;
        let mut visited = vec![false; nodes.len()];
        let mut stack: Vec<(usize, DMat4, (&str, usize))> = Vec::new();
        let scene = ("scene", self.scene);
        stack.extend(
            roots
                .into_iter()
                .rev()
                .map(|root| (root, DMat4::IDENTITY, scene)),
        );
        while let Some((number, parent, by)) = stack.pop() {
            let node = item(nodes, "node", number, by, name)?;
            if std::mem::replace(&mut visited[number], true) {
                return Err(fault(name, "node", number, GltfFault::NodeRepeated));
            }
            let place = parent * local_transform(node);
            let by = ("node", number);
            if node.matrix.is_some() {
                let others = [
                    node.translation.is_some(),
                    node.rotation.is_some(),
                    node.scale.is_some(),
                ];
                let count = others.into_iter().filter(|&is_given| is_given).count();
                let kind = IgnoredKind::NodeTransforms;
                self.note("node", number, kind, count);
            }
            if let Some(mesh) = node.mesh {
                let place = self.mesh_place(node, place, number)?;
                self.read_mesh(mesh, place, node.weights.as_deref(), by)?;
            }
            stack.extend(node.children.iter().rev().map(|&child| (child, place, by)));
        }
        let unused = (0..nodes.len()).filter(|&n| !visited[n]);
        let unused = unused.filter_map(|n| Some((n, nodes[n].mesh?)));
        for (_, mesh) in unused.clone() {
            // The note about the node says it.
            if let Some(is_used) = self.used.get_mut(mesh) {
                *is_used = true;
            }
        }
        if let Some((first, _)) = unused.clone().next() {
            self.note("node", first, IgnoredKind::UnusedNodes, unused.count());
        }
        Ok(())
    }

    /// Returns the place of the mesh of node `number`, which is at `place`, and notes what is not
    /// applied to it. The place of a node does not move a mesh with a skin: its joints do, which are
    /// not read.
    fn mesh_place(&mut self, node: &Node, place: DMat4, number: usize) -> Result<DMat4, ReadError> {
        let by = Place::Item {
            kind: "node",
            number,
        };
        if node.extensions.contains_key(INSTANCING) {
            self.builder.notices.add(IgnoredKind::Instances, by);
        }
        let Some(skin) = node.skin else {
            return Ok(place);
        };
        let by_node = ("node", number);
        item(
            &self.document.skins,
            "skin",
            skin,
            by_node,
            self.buffers.name,
        )?;
        self.builder.notices.add(IgnoredKind::Skins, by);
        Ok(DMat4::IDENTITY)
    }

    /// Adds a mesh at a place. `weights` are those of its morph targets, if the node has some.
    fn read_mesh(
        &mut self,
        number: usize,
        place: DMat4,
        weights: Option<&[f64]>,
        by: (&'static str, usize),
    ) -> Result<(), ReadError> {
        let mesh = item(&self.document.meshes, "mesh", number, by, self.buffers.name)?;
        self.used[number] = true;
        let weights = weights.unwrap_or(&mesh.weights);
        // Primitives that share positions and what moves them share vertices.
        let mut first_vertices: HashMap<(usize, Vec<(usize, u64)>), usize> = HashMap::new();
        for primitive in &mesh.primitives {
            // A scene can repeat a mesh whose primitives are empty.
            let parts = 1 + (primitive.attributes.len() + primitive.targets.len()) as u64;
            self.spend(PRIMITIVE_COST.saturating_mul(parts))?;
            let morphs = morphs(primitive, weights);
            self.note_ignored(primitive, morphs.len(), number);
            let Some(&positions) = primitive.attributes.get("POSITION") else {
                continue;
            };
            let bits = morphs
                .iter()
                .map(|&(target, weight)| (target, weight.to_bits()));
            let key = (positions, bits.collect());
            let first = match first_vertices.get(&key) {
                Some(&first) => first,
                None => {
                    let first = self.builder.vertex_count();
                    self.read_positions(positions, &morphs, place, ("mesh", number))?;
                    first_vertices.insert(key, first);
                    first
                }
            };
            let vertices = self.document.accessors[positions].count;
            self.read_triangles(
                primitive,
                first,
                vertices,
                place.determinant() < 0.0,
                number,
            )?;
        }
        Ok(())
    }

    /// Counts the data of a primitive that is not kept. `morphs` is the number of morph targets that are applied.
    fn note_ignored(&mut self, primitive: &Primitive, morphs: usize, number: usize) {
        let place = Place::Item {
            kind: "mesh",
            number,
        };
        let notices = &mut self.builder.notices;
        for (name, &accessor) in &primitive.attributes {
            let count = self
                .document
                .accessors
                .get(accessor)
                .map_or(0, |accessor| accessor.count);
            let prefix = name.split('_').next().unwrap_or_default();
            match prefix {
                "POSITION" => {}
                "NORMAL" => notices.add_many(IgnoredKind::Normals, count, place),
                "TANGENT" => notices.add_many(IgnoredKind::Tangents, count, place),
                "TEXCOORD" => notices.add_many(IgnoredKind::TextureCoordinates, count, place),
                "COLOR" => notices.add_many(IgnoredKind::Colours, count, place),
                _ => notices.add_named(IgnoredKind::Properties, 1, place, name),
            }
        }
        notices.add_many(
            IgnoredKind::Materials,
            u64::from(primitive.material.is_some()),
            place,
        );
        notices.add_many(
            IgnoredKind::Deformations,
            (primitive.targets.len() - morphs) as u64,
            place,
        );
        // Points without indices are the vertices, which are kept.
        let is_lost = primitive.mode > 0 || primitive.indices.is_some();
        if primitive.mode < 4 && is_lost {
            notices.add(IgnoredKind::OtherPrimitives, place);
        }
    }

    /// Subtracts `count` vertices, corners or primitives from those that may be added.
    fn spend(&mut self, count: u64) -> Result<(), ReadError> {
        let limit = self.limit;
        self.left = self.left.checked_sub(count).ok_or_else(|| {
            let at = self.builder.at(Place::Item {
                kind: "scene",
                number: self.scene,
            });
            let fault = GltfFault::TooLarge { limit };
            ReadError::Gltf { at, fault }
        })?;
        Ok(())
    }

    /// Adds the vertices of an accessor, moved by `morphs`.
    fn read_positions(
        &mut self,
        number: usize,
        morphs: &[(usize, f64)],
        place: DMat4,
        by: (&'static str, usize),
    ) -> Result<(), ReadError> {
        let mut positions = elements(self.document, self.buffers, number, 3, by)?;
        self.spend(positions.count.saturating_mul(1 + morphs.len() as u64))?;
        let mut targets = Vec::with_capacity(morphs.len());
        for &(target, weight) in morphs {
            let moves = elements(self.document, self.buffers, target, 3, by)?;
            if moves.count != positions.count {
                let (found, expected) = (moves.count, positions.count);
                let counts = GltfFault::TargetCount { found, expected };
                return Err(fault(self.buffers.name, "accessor", target, counts));
            }
            targets.push((target, weight, moves));
        }
        if !positions.is_unbounded() {
            let count = usize::try_from(positions.count).unwrap_or(0);
            self.builder.reserve_vertices(count);
        }
        let kind = "accessor";
        let stays = place == DMat4::IDENTITY;
        for vertex in 0..positions.count {
            let position = positions.position(vertex);
            let mut position = position.map_err(|f| fault(self.buffers.name, kind, number, f))?;
            if !stays || !targets.is_empty() {
                let mut moved = DVec3::from_array(position.map(|c| c.wide));
                for (target, weight, moves) in &mut targets {
                    let by = moves.position(vertex);
                    let by = by.map_err(|f| fault(self.buffers.name, kind, *target, f))?;
                    moved += *weight * DVec3::from_array(by.map(|c| c.wide));
                }
                let moved = place.transform_point3(moved);
                position = moved.to_array().map(Coordinate::from);
            }
            self.builder
                .push_vertex(position, Place::Item { kind, number })?;
        }
        Ok(())
    }
}

/// Returns the morph targets of a primitive that move its positions: the accessor of each, and its weight.
fn morphs(primitive: &Primitive, weights: &[f64]) -> Vec<(usize, f64)> {
    let targets = primitive.targets.iter().zip(weights);
    let applied = targets.filter_map(|(target, &weight)| {
        let &accessor = target.get("POSITION").filter(|_| weight != 0.0)?;
        Some((accessor, weight))
    });
    applied.collect()
}

/// Returns the place of a node relative to its parent.
fn local_transform(node: &Node) -> DMat4 {
    if let Some(matrix) = &node.matrix {
        return DMat4::from_cols_array(matrix);
    }
    let [x, y, z, w] = node.rotation.unwrap_or([0.0, 0.0, 0.0, 1.0]);
    let scale = DVec3::from_array(node.scale.unwrap_or([1.0; 3]));
    let translation = DVec3::from_array(node.translation.unwrap_or([0.0; 3]));
    // The specification wants unit length. Rounded files have nearly that, and others would scale.
    let rotation = DVec4::new(x, y, z, w).try_normalize();
    let rotation = rotation.map_or(DQuat::IDENTITY, DQuat::from_vec4);
    DMat4::from_scale_rotation_translation(scale, rotation, translation)
}
