//! Meshes on which a structure behaves unlike on the others.

use sixfold_results::numbers::{counted, times};
use sixfold_results::statistics::median_and_deviation;
use sixfold_results::{Pool, Purpose};

use super::{Mesh, Relative, kind, leaders_of};
use crate::figure::{Table, TitledTable};

/// A deviation of more than this number of standard deviations is an outlier.
const FAR: f64 = 3.5;
/// A smaller factor is never an outlier.
const LEAST_FACTOR: f64 = 1.5;
/// Fewer meshes have no outliers.
const FEWEST: usize = 5;
/// The largest number of rows.
const MOST: usize = 15;

/// A mesh on which ratios are far from the medians of all meshes, in one kind of work.
struct Outlier<'m, 'r> {
    mesh: &'m Mesh<'r>,
    purpose: Purpose,
    leader: &'m str,
    /// The ratios with their medians, the farthest first.
    rows: Vec<(Relative<'m>, f64)>,
}

/// Returns the factor between a ratio and the median, at least 1.
fn factor((row, median): &(Relative<'_>, f64)) -> f64 {
    let factor = row.ratio / median;
    factor.max(factor.recip())
}

/// Returns the table of the outliers, or `None` if there are none. The farthest outlier comes first.
pub(super) fn table(pool: &Pool, meshes: &[Mesh<'_>]) -> Option<TitledTable> {
    let leaders = leaders_of(pool);
    let outliers = leaders
        .iter()
        .flat_map(|&(purpose, leader)| outliers(meshes, purpose, leader));
    let mut outliers: Vec<Outlier<'_, '_>> = outliers.collect();
    outliers.sort_by(|a, b| factor(&b.rows[0]).total_cmp(&factor(&a.rows[0])));
    let count = outliers.len();
    let header = [
        "mesh",
        "work",
        "compared with",
        "structures, here and in the median",
        "kind of mesh",
    ];
    let mut table = Table::new(header);
    for outlier in outliers.iter().take(MOST) {
        let mesh = outlier.mesh;
        let faces = counted(mesh.study.mesh.facts.faces, "face", "faces");
        let cells = vec![
            mesh.name.clone(),
            outlier.purpose.title().to_lowercase(),
            outlier.leader.to_owned(),
            shown(outlier),
            format!("{}, {faces}", kind(mesh.study)),
        ];
        table.linked_row(cells, mesh.id.clone());
    }
    let shown = match count {
        0 => return None,
        count if count > MOST => format!(" The {MOST} farthest of {count} are shown."),
        _ => String::new(),
    };
    Some(TitledTable {
        title: "Outliers".into(),
        caption: format!(
            "Meshes on which the mean time of a structure, divided by that of the structure that is the fastest on average, is \
             far from the median of all meshes: by more than {FAR} standard deviations (estimated from the median deviation), and by a factor of at least \
             {LEAST_FACTOR}. If nearly all structures deviate, the one they are compared with is unusual.{shown}"
        ),
        table,
    })
}

/// Returns the outliers of one kind of work.
fn outliers<'m, 'r>(
    meshes: &'m [Mesh<'r>],
    purpose: Purpose,
    leader: &'m str,
) -> Vec<Outlier<'m, 'r>> {
    let rows = meshes.iter().flat_map(|mesh| {
        let rows = mesh.relative_to(leader, purpose).into_iter();
        rows.filter(|row| !row.bound).map(move |row| (mesh, row))
    });
    let rows: Vec<(&Mesh<'_>, Relative<'_>)> = rows.collect();
    let mut backends: Vec<&str> = rows.iter().map(|(_, row)| row.backend).collect();
    backends.sort_unstable();
    backends.dedup();
    let mut found: Vec<Outlier<'m, 'r>> = Vec::new();
    for backend in backends {
        let own = || rows.iter().filter(|(_, row)| row.backend == backend);
        let logs: Vec<f64> = own().map(|(_, row)| row.ratio.ln()).collect();
        let Some((middle, deviation)) =
            median_and_deviation(&logs).filter(|_| logs.len() >= FEWEST)
        else {
            continue;
        };
        let far = (FAR * deviation).max(LEAST_FACTOR.ln());
        for (mesh, row) in own().filter(|(_, row)| (row.ratio.ln() - middle).abs() > far) {
            let row = (*row, middle.exp());
            match found.iter_mut().find(|outlier| outlier.mesh.id == mesh.id) {
                Some(known) => known.rows.push(row),
                None => found.push(Outlier {
                    mesh,
                    purpose,
                    leader,
                    rows: vec![row],
                }),
            }
        }
    }
    for outlier in &mut found {
        outlier.rows.sort_by(|a, b| factor(b).total_cmp(&factor(a)));
    }
    found
}

/// Returns the structures of an outlier: `corner-table 0.353 × (2.21 ×), winged-edge 0.483 × (1.70 ×)`.
fn shown(outlier: &Outlier<'_, '_>) -> String {
    let rows = outlier.rows.iter();
    let rows = rows
        .map(|(row, median)| format!("{} {} ({})", row.backend, times(row.ratio), times(*median)));
    rows.collect::<Vec<_>>().join(", ")
}
