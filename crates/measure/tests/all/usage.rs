//! The lines of Rust that `pick` prints for each backend. A test of the module `usage` looks for the printed
//! lines in this file.

#![allow(
    dead_code,
    reason = "the functions need a file; they only must compile"
)]

use std::error::Error;

use sixfold::MeshEdit;

type Done = Result<(), Box<dyn Error>>;

/// A structure of another package.
mod mine {
    pub(crate) mod inner {
        pub(crate) type Mesh = sixfold::HalfEdgeMesh;
    }
}

fn polygon_soup() -> Done {
    use sixfold::{PolygonSoup, io};
    let mesh: PolygonSoup = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_polygon_soup() -> Done {
    use sixfold::{EditablePolygonSoup, io};
    let mut mesh: EditablePolygonSoup = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn indexed_face_set() -> Done {
    use sixfold::{IndexedFaceSet, io};
    let mesh: IndexedFaceSet = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_indexed_face_set() -> Done {
    use sixfold::{EditableIndexedFaceSet, io};
    let mut mesh: EditableIndexedFaceSet = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn face_vertex_mesh() -> Done {
    use sixfold::{FaceVertexMesh, io};
    let mesh: FaceVertexMesh = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_face_vertex_mesh() -> Done {
    use sixfold::{EditableFaceVertexMesh, io};
    let mut mesh: EditableFaceVertexMesh = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn winged_edge_mesh() -> Done {
    use sixfold::{WingedEdgeMesh, io};
    let mesh: WingedEdgeMesh = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_winged_edge_mesh() -> Done {
    use sixfold::{EditableWingedEdgeMesh, io};
    let mut mesh: EditableWingedEdgeMesh = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn half_edge_mesh() -> Done {
    use sixfold::{HalfEdgeMesh, io};
    let mesh: HalfEdgeMesh = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_half_edge_mesh() -> Done {
    use sixfold::{EditableHalfEdgeMesh, io};
    let mut mesh: EditableHalfEdgeMesh = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn corner_table() -> Done {
    use sixfold::{CornerTable, io};
    let mesh: CornerTable = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn editable_corner_table() -> Done {
    use sixfold::{EditableCornerTable, io};
    let mut mesh: EditableCornerTable = io::load("mesh.obj")?;
    mesh.compact();
    drop(mesh);
    Ok(())
}

fn of_another_package() -> Done {
    use mine::inner::Mesh;
    use sixfold::io;
    let mesh: Mesh = io::load("mesh.obj")?;
    drop(mesh);
    Ok(())
}

fn one_table() -> Done {
    use sixfold::{FaceVertexMesh, Relation, RelationTables, io};
    let mesh: FaceVertexMesh = io::load("mesh.obj")?;
    let relations = [Relation::VertexVertices];
    let tables = RelationTables::new(&mesh, &relations)?;
    drop(tables);
    Ok(())
}

fn two_tables() -> Done {
    use sixfold::{FaceVertexMesh, Relation, RelationTables, io};
    let mesh: FaceVertexMesh = io::load("mesh.obj")?;
    let relations = [Relation::VertexVertices, Relation::VertexEdges];
    let tables = RelationTables::new(&mesh, &relations)?;
    drop(tables);
    Ok(())
}

fn all_tables() -> Done {
    use sixfold::{FaceVertexMesh, Relation, RelationTables, io};
    let mesh: FaceVertexMesh = io::load("mesh.obj")?;
    let relations = [
        Relation::VertexVertices,
        Relation::VertexEdges,
        Relation::VertexFaces,
        Relation::EdgeVertices,
        Relation::EdgeEdges,
        Relation::EdgeFaces,
        Relation::FaceVertices,
        Relation::FaceEdges,
        Relation::FaceFaces,
    ];
    let tables = RelationTables::new(&mesh, &relations)?;
    drop(tables);
    Ok(())
}
