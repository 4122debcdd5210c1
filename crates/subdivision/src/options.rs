//! The options of a scheme.

sixfold_core::named! {
    /// The treatment of the boundary of the mesh.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum BoundaryRule: "boundary rule" {
        /// Boundary edges are infinitely sharp, and so are vertices with exactly one face.
        #[default]
        EdgeAndCorner = "edge-and-corner",
        /// Boundary edges are infinitely sharp. The boundary becomes a B-spline curve, which rounds
        /// the corners of the mesh.
        EdgeOnly = "edge-only",
        /// A face is removed from the result if one of its vertices has a boundary edge without
        /// infinite sharpness in the input. A removed face still influences the adjacent faces.
        None = "none",
    }
}

sixfold_core::named! {
    /// The rule that computes the sharpness of the two halves of an edge after a step.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum Creasing: "creasing rule" {
        /// Each half gets the sharpness of the edge minus 1, but at least 0. An infinite sharpness
        /// stays infinite.
        #[default]
        Uniform = "uniform",
        /// The half at one end of the edge gets 3/4 of the sharpness of the edge, plus 1/4 of the
        /// mean sharpness of the other semi-sharp edges at this end, minus 1. Sharpness then varies
        /// along a crease like the points of Chaikin's curve. A semi-sharp edge has a finite
        /// sharpness above 0. The rule [`Uniform`](Self::Uniform) applies to edges that are not
        /// semi-sharp, and at ends without another semi-sharp edge.
        Chaikin = "chaikin",
    }
}

sixfold_core::named! {
    /// The weights of Loop's scheme for the neighbours of an extraordinary vertex.
    #[derive(Default)]
    #[non_exhaustive]
    pub enum LoopWeights: "set of Loop weights" {
        /// The weights of Loop (1987).
        #[default]
        Loop = "loop",
        /// The weights of Warren (1995): 3/(8n) for valence n, but 3/16 for valence 3.
        Warren = "warren",
    }
}
