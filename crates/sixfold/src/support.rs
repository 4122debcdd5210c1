//! Which scheme runs on which structure, as data.

use mesh_core::Refine;
use serde::Serialize;
use subdivision::{Method, Scheme};

use crate::roster::{RefineVisitor, roster, visit_refinable};

/// What one structure can do with one scheme.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Support {
    /// The structure, by name.
    pub backend: &'static str,
    /// The scheme.
    pub scheme: Scheme,
    /// The ways to run it; [`Method::Native`] where the structure can split its own tables so.
    pub methods: Vec<Method>,
    /// Whether the structure holds what a step makes. Where it does not, the first step can be taken,
    /// to polygons, and a second would have to hold them.
    pub holds_result: bool,
}

impl Support {
    /// The method that is used where none is asked for: the last of those there are.
    pub fn best(&self) -> Option<Method> {
        self.methods.last().copied()
    }
}

/// What every structure can do with `scheme`, in the order of the [`roster`].
pub fn support(scheme: Scheme) -> Vec<Support> {
    let kind = scheme.kind();
    let rows = roster().into_iter().map(|backend| {
        let mut methods = vec![Method::Gather];
        if kind.scatter {
            methods.push(Method::Scatter);
        }
        let native = visit_refinable(backend.name, &mut Splits(scheme));
        if native == Some(true) {
            methods.push(Method::Native);
        }
        Support {
            backend: backend.name,
            scheme,
            methods,
            holds_result: backend.capabilities.polygons || kind.makes == "triangles",
        }
    });
    rows.collect()
}

/// Whether a structure can split its own tables as a scheme asks.
struct Splits(Scheme);

impl RefineVisitor for Splits {
    type Output = bool;

    fn visit<M: Refine + 'static>(&mut self) -> bool {
        let wanted = self.0.kind().split;
        wanted.is_some_and(|wanted| M::SPLITS.iter().any(|split| split.name() == wanted.name()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quads_do_not_fit_a_corner_table() {
        let row = |scheme| {
            let rows = support(scheme);
            let mut rows = rows.into_iter();
            rows.find(|row| row.backend == "corner-table")
                .expect("one of six")
        };
        assert!(!row(Scheme::CatmullClark).methods.contains(&Method::Native));
        assert!(!row(Scheme::CatmullClark).holds_result);
        assert_eq!(row(Scheme::Loop).best(), Some(Method::Native));
        assert!(row(Scheme::Loop).holds_result);
    }
}
