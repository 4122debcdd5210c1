//! The subdivision schemes that each structure supports.

use sixfold_core::Split;
use sixfold_subdivision::{FaceKind, Method, Scheme};

use crate::structure_list::{StructureInfo, structure_infos};

/// How one structure supports one subdivision scheme.
#[derive(Clone, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
pub struct Support {
    /// The name of the structure.
    pub backend: &'static str,
    /// The scheme.
    pub scheme: Scheme,
    /// The methods of subdivision that the structure supports. [`Method::Native`] is in the list if
    /// the structure can split its own tables as the scheme requires.
    pub methods: Vec<Method>,
    /// True if the structure can hold the result of a step. If false, the first step is possible
    /// and returns polygons, but a second step is not possible.
    pub holds_result: bool,
}

impl Support {
    /// Returns the default method: the last method in `methods`.
    pub fn default_method(&self) -> Option<Method> {
        self.methods.last().copied()
    }
}

impl StructureInfo {
    /// Returns how this structure supports `scheme`.
    pub fn support(&self, scheme: Scheme) -> Support {
        let properties = scheme.properties();
        let mut methods = vec![Method::Gather];
        if properties.scatter {
            methods.push(Method::Scatter);
        }
        let is_known = |wanted: Split| self.splits.iter().any(|s| s.name() == wanted.name());
        if properties.split.is_some_and(is_known) {
            methods.push(Method::Native);
        }
        Support {
            backend: self.name,
            scheme,
            methods,
            holds_result: self.capabilities.polygons || properties.makes == FaceKind::Triangles,
        }
    }
}

/// Returns how every structure supports `scheme`, in the order of [`structure_infos`].
pub fn support(scheme: Scheme) -> Vec<Support> {
    let infos = structure_infos().into_iter();
    infos.map(|info| info.support(scheme)).collect()
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
