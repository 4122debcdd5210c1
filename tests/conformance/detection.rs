//! Every law fails for at least one flawed structure, with a message about the structure and the
//! fault.

use std::panic::catch_unwind;

use sixfold_conformance::{check_law, law};

use super::flawed::{Flaw, FlawKind, Flawed};
use crate::face_and_edge_lists::FaceAndEdgeLists;

/// `FlawKind => law, "words of the message"` makes a test: the law must fail for the structure with
/// this flaw, with a message that contains these words.
macro_rules! detects {
    (meshes { $($flaw:ident => $law:ident, $words:literal;)+ }
     structures { $($structural_flaw:ident => $structural:ident, $structural_words:literal;)+ }) => {
        detects!(@flaws $($flaw)+ $($structural_flaw)+);

        #[expect(non_snake_case, reason = "each test has the name of its flaw")]
        mod meshes {
            use super::*;
            $(
                #[test]
                fn $flaw() {
                    let fault = fault(|| check_law::<Flawed<flaws::$flaw>>(stringify!($law), law::$law::<Flawed<flaws::$flaw>>));
                    assert_reported(&fault, $words);
                }
            )+
        }

        #[expect(non_snake_case, reason = "each test has the name of its flaw")]
        mod structures {
            use super::*;
            $(
                #[test]
                fn $structural_flaw() {
                    assert_reported(&fault(law::$structural::<Flawed<flaws::$structural_flaw>>), $structural_words);
                }
            )+
        }

        const DETECTED: &[&str] = &[$(stringify!($law),)+ $(stringify!($structural)),+];
    };
    (@flaws $($flaw:ident)+) => {
        mod flaws {
            $(
                #[derive(Clone, Copy, Debug)]
                pub(super) struct $flaw;

                impl super::Flaw for $flaw {
                    const KIND: super::FlawKind = super::FlawKind::$flaw;
                }
            )+
        }
    };
}

detects! {
    meshes {
        NeighbourTwice => vertex_vertices, "vertex_vertices of v0 yields v";
        VertexAdjacentToItself => vertex_vertices, "vertex_vertices of v0 yields v0 itself";
        EdgeLeftOut => vertex_edges, "vertex_edges of v0";
        FaceLeftOut => vertex_faces, "vertex_faces of v0";
        EndTwice => edge_vertices, "an element v";
        EdgeAdjacentToItself => edge_edges, "itself";
        ThirdFaceLeftOut => edge_faces, "edge_faces of v0–v1";
        CornersReversed => face_vertices, "face_vertices of f0";
        SidesShifted => face_edges, "face_edges of f0";
        FaceTwiceAcrossTwoEdges => face_faces, "yields f1 twice";
        HigherEdgesOnly => symmetry, "edge_edges of";
        RingReversed => one_ring, "one_ring of v0";
        RingFromTheMiddle => one_ring, "one_ring of v0";
        RingOfABowTie => one_ring, "expected None";
        NoRingOfAnIsolatedVertex => one_ring, "is None";
        SidesReversed => oriented_walk, "side_origin of";
        SideTwiceInItsFace => oriented_walk, "sides of f0";
        SideOfAnEdgeLeftOut => oriented_walk, "edge_sides of v0–v1";
        OutgoingSideLeftOut => oriented_walk, "outgoing_sides of v0";
        IncomingSides => oriented_walk, "outgoing_sides of v0";
        NextSideSkipsOne => oriented_walk, "next_side of";
        PrevSideIsNext => oriented_walk, "prev_side of";
        TwinOfABoundarySide => oriented_walk, "twin_side of";
        TwinAmongSeveral => oriented_walk, "twin_side of";
        TwinOfTheSameDirection => oriented_walk, "twin_side of";
        NoTwin => oriented_walk, "twin_side of";
        TargetIsTheOrigin => oriented_walk, "side_target of";
        FaceOfTheTwin => oriented_walk, "side_face of";
        EdgeOfTheNextSide => oriented_walk, "side_edge of";
        TurnsReversed => oriented_walk, "cw_side of";
        SideCountOff => oriented_walk, "side_count()";
        SideFoldEndsEarly => oriented_walk, "outgoing_sides of v0 by fold after 0 times next";
        MissingSideStartsAtV0 => oriented_walk, "side_origin of the missing";
        ValenceOff => predicates, "valence of v0";
        DegreeOff => predicates, "degree of f0";
        NoBoundaryVertex => predicates, "is_boundary_vertex of v";
        NoBoundaryEdge => predicates, "is_boundary_edge of v";
        LastVertexNotContained => predicates, "contains_vertex of v";
        LastEdgeNotContained => predicates, "contains_edge of v";
        LastFaceNotContained => predicates, "contains_face of f";
        NoCommonFace => predicates, "common_face of v0 and v";
        OppositeVertexOfAnyFace => predicates, "opposite_vertex of f";
        EdgeBetweenAnyVertices => predicates, "edge_between of v0 and v";
        EdgeToTheVertexItself => predicates, "edge_between of v0 and v0";
        CommonFaceOfAnyVertices => predicates, "common_face of v0 and v";
        OppositeVertexOfAnyEdge => predicates, "opposite_vertex of f";
        BoundaryEdgeLeftOut => boundary_loops, "boundary_edges";
        LoopReversed => boundary_loops, "boundary_loops";
        FaceCountOff => boundary_loops, "edge_face_counts of v";
        FoldEndsEarly => folds, "vertex_vertices of v0 by fold after 0 times next";
        FoldStartsAgain => folds, "vertex_vertices of v0 by fold after 1 times next";
        NumbersReversed => numbers, "handles of the numbers";
        ContainsMissingVertex => missing_handles, "contains_vertex of v";
        ContainsMissingEdge => missing_handles, "contains_edge of e";
        ContainsMissingFace => missing_handles, "contains_face of f";
        EdgeIteratedTwice => elements, "twice";
        FacesOutOfOrder => elements, "faces() is";
        VertexCountOff => elements, "vertex_count()";
        FaceNameOff => names, "f";
        VertexNameOff => names, "vertex_handle gives";
        PositionOff => positions, "position of v";
        TooFewRows => maps, "no e";
        EmptyForMissingRow => missing_handles, "vertex_vertices of a missing element";
        MessageWithoutHandle => missing_handles, "vertex_vertices of a missing element";
        LimitsIgnored => build_limits, "CAPABILITIES.check (right) with at most 0 rows";
        AcceptsEverything => verdict, "from_polygons (left) and CAPABILITIES.check (right)";
        RejectsIsolated => verdict, "IsolatedVertex";
        WrongError => verdict, "NonManifoldVertex";
        FaceReversedOnExport => round_trip, "of to_polygons is";
        LastVertexNotMoved => set_positions, "after set_positions";
        SecondMoveIgnored => set_positions, "after set_positions";
        MoveReportsRemoval => set_positions, "vertices that set_positions_logged leaves";
        ValidateFails => invariants, "validate: I9 fails";
        DifferentWhenProbed => probed, "probed (left) and not probed (right)";
    }
    structures {
        DuplicateFaceLeftOut => corner_cases, "face_faces f0";
        AllConstant => costs, "vertex_vertices is declared Constant";
        AllLocal => costs, "vertex_vertices is declared Local";
        AllScan => costs, "edge_vertices is declared Scan";
        LocalByName => costs, "is_local";
        CostOfAnotherRelation => costs, "cost of vertex_faces";
        MemoryTooLarge => memory, "layout_bytes is";
    }
}

#[test]
fn a_walk_that_scans_is_found() {
    let fault = fault(law::oriented_walk_costs::<FaceAndEdgeLists>);
    assert!(fault.contains("side_edge scans"), "{fault}");
}

fn fault(run: impl FnOnce() + std::panic::UnwindSafe) -> String {
    let outcome = catch_unwind(run);
    let payload = outcome.expect_err("the suite passes a flawed structure");
    let message = payload.downcast_ref::<String>();
    message.expect("a law panics with a message").clone()
}

fn assert_reported(fault: &str, words: &str) {
    assert!(fault.contains(words), "“{words}” is not in:\n{fault}");
    assert!(
        fault.contains("flawed"),
        "the name of the structure is not in:\n{fault}"
    );
}

#[test]
fn every_law_detects_a_flaw() {
    for law in law::NAMES {
        assert!(
            DETECTED.contains(law),
            "no test shows that {law} detects a flaw"
        );
    }
}

#[test]
fn a_failing_mesh_shrinks_and_is_shown() {
    type Lists = crate::face_and_edge_lists::FaceAndEdgeLists;
    let fault = fault(|| {
        check_law::<Lists>("no_heptagon", |polygons| {
            let mut faces = polygons.faces().iter();
            assert!(faces.all(|(_, face)| face.len() != 7), "a heptagon");
        });
    });
    let first = fault.lines().next().expect("a line");
    assert!(
        first.starts_with("face-and-edge-lists: no_heptagon fails on "),
        "{fault}"
    );
    assert!(fault.contains("\na heptagon\n(at "), "{fault}");
    assert!(first.contains("on 7 vertices, faces ["), "{fault}");
    assert_eq!(first.matches('[').count(), 1, "{fault}");
}
