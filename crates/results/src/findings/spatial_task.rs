//! What `neighbours` measures: building the indices, and the queries.

sixfold_core::named! {
    /// One task: building an index, or one kind of query.
    #[derive(Default)]
    pub enum SpatialTask: "spatial task" {
        /// Builds the index of the vertices.
        #[default]
        BuildVertices = "build_vertices",
        /// Finds the nearest vertex of each query point.
        NearestVertex = "nearest_vertex",
        /// Visits all vertices within a radius of each query point.
        VerticesWithin = "vertices_within",
        /// Finds the eight nearest vertices of each query point.
        NearestEight = "nearest_eight",
        /// Builds the index of the triangles.
        BuildTriangles = "build_triangles",
        /// Finds the point of the surface that is closest to each query point.
        ClosestPoint = "closest_point",
        /// Finds where each ray first hits the surface.
        FirstHit = "first_hit",
    }
}

impl SpatialTask {
    /// Returns the unit of the elements that the task counts: `vertex`, `triangle`, `query` or
    /// `ray`.
    pub const fn unit(self) -> &'static str {
        match self {
            Self::BuildVertices => "vertex",
            Self::BuildTriangles => "triangle",
            Self::FirstHit => "ray",
            _ => "query",
        }
    }

    /// Returns the task that builds the index for this query; `None` if the task is not a query.
    pub const fn build(self) -> Option<Self> {
        match self {
            Self::BuildVertices | Self::BuildTriangles => None,
            Self::NearestVertex | Self::VerticesWithin | Self::NearestEight => {
                Some(Self::BuildVertices)
            }
            Self::ClosestPoint | Self::FirstHit => Some(Self::BuildTriangles),
        }
    }
}

sixfold_core::named! {
    /// Where the query points are.
    #[derive(Default)]
    pub enum QueryPoints: "set of query points" {
        /// Near the surface: vertices, each moved by up to 1 % of the diagonal of the bounding box,
        /// in the order of the mesh. Registration and the distance between similar meshes have such
        /// queries.
        #[default]
        Near = "near",
        /// Anywhere in the bounding box, in random order. Signed distance fields have such queries.
        Box = "box",
    }
}
