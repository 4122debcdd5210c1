//! Meshes as lists of faces: their topology, their faults, and what structures can hold.

pub(crate) mod capability;
pub(crate) mod classes;
pub(crate) mod counts;
pub(crate) mod creases;
pub(crate) mod error;
pub(crate) mod face_list;
pub(crate) mod faces_by_lowest;
pub(crate) mod facts;
pub(crate) mod fans;
pub(crate) mod incidence;
pub(crate) mod newell;
pub(crate) mod partition;
pub(crate) mod polygon_mesh;
pub(crate) mod triangulation;
