//! What every scheme keeps, on random meshes.
