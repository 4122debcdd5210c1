//! A table of which subdivision scheme runs on which structure.

use sixfold_core::Refine;
use sixfold_subdivision::{Method, Scheme};

use crate::roster::{RefineVisitor, roster, visit_refinable};

/// How one structure supports one scheme.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Support {
    /// Name of the structure.
    pub backend: &'static str,
    /// The scheme.
    pub scheme: Scheme,
    /// Available methods; [`Method::Native`] is one of them if the structure can split its own
    /// tables as the scheme requires.
    pub methods: Vec<Method>,
    /// Whether the structure can hold the result of a step. If not, one step can be made, with
    /// polygons as the result. A second step would have to hold these polygons.
    pub holds_result: bool,
}

impl Support {
    /// Returns the default method: the last available one.
    pub fn default_method(&self) -> Option<Method> {
        self.methods.last().copied()
    }
}

/// Returns how every structure supports `scheme`, in the order of the [`roster`].
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

/// A visitor that returns whether a structure can split its own tables as the scheme requires.
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
        assert_eq!(row(Scheme::Loop).default_method(), Some(Method::Native));
        assert!(row(Scheme::Loop).holds_result);
    }
}
