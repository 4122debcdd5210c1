//! The correct structure with one flaw at a time.

mod items;
mod query;
mod representation;
mod walk;

use std::marker::PhantomData;

use sixfold_core::{Probe, Untraced};

use crate::face_and_edge_lists::FaceAndEdgeLists;

/// The kind of flaw.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum FlawKind {
    NeighbourTwice,
    VertexAdjacentToItself,
    EdgeLeftOut,
    FaceLeftOut,
    EndTwice,
    EdgeAdjacentToItself,
    ThirdFaceLeftOut,
    CornersReversed,
    SidesShifted,
    FaceTwiceAcrossTwoEdges,
    DuplicateFaceLeftOut,
    HigherEdgesOnly,
    RingReversed,
    RingFromTheMiddle,
    RingOfABowTie,
    NoRingOfAnIsolatedVertex,
    SidesReversed,
    SideTwiceInItsFace,
    SideOfAnEdgeLeftOut,
    OutgoingSideLeftOut,
    IncomingSides,
    NextSideSkipsOne,
    PrevSideIsNext,
    TwinOfABoundarySide,
    TwinAmongSeveral,
    TwinOfTheSameDirection,
    NoTwin,
    TargetIsTheOrigin,
    FaceOfTheTwin,
    EdgeOfTheNextSide,
    TurnsReversed,
    SideCountOff,
    SideFoldEndsEarly,
    MissingSideStartsAtV0,
    ValenceOff,
    DegreeOff,
    NoBoundaryVertex,
    NoBoundaryEdge,
    LastVertexNotContained,
    LastEdgeNotContained,
    LastFaceNotContained,
    ContainsMissingVertex,
    ContainsMissingEdge,
    ContainsMissingFace,
    NoCommonFace,
    OppositeVertexOfAnyFace,
    EdgeBetweenAnyVertices,
    EdgeToTheVertexItself,
    CommonFaceOfAnyVertices,
    OppositeVertexOfAnyEdge,
    BoundaryEdgeLeftOut,
    LoopReversed,
    FaceCountOff,
    FoldEndsEarly,
    FoldStartsAgain,
    NumbersReversed,
    EdgeIteratedTwice,
    FacesOutOfOrder,
    VertexCountOff,
    FaceNameOff,
    VertexNameOff,
    PositionOff,
    TooFewRows,
    EmptyForMissingRow,
    MessageWithoutHandle,
    AcceptsEverything,
    LimitsIgnored,
    RejectsIsolated,
    WrongError,
    FaceReversedOnExport,
    LastVertexNotMoved,
    SecondMoveIgnored,
    MoveReportsRemoval,
    ValidateFails,
    DifferentWhenProbed,
    AllConstant,
    AllLocal,
    AllScan,
    LocalByName,
    CostOfAnotherRelation,
    MemoryTooLarge,
}

/// A type for each [`FlawKind`].
pub(crate) trait Flaw: Copy + std::fmt::Debug + Send + Sync + 'static {
    const KIND: FlawKind;
}

/// [`FaceAndEdgeLists`] with flaw `F`.
#[derive(Clone, Debug)]
pub(crate) struct Flawed<F: Flaw, P: Probe = Untraced> {
    inner: FaceAndEdgeLists<P>,
    is_probed: bool,
    moves: u32,
    flaw: PhantomData<F>,
}

impl<F: Flaw, P: Probe> Flawed<F, P> {
    fn is(&self, kind: FlawKind) -> bool {
        F::KIND == kind
    }

    /// Repeats the first item if the flaw is `kind`.
    fn with_duplicate<T: Copy>(&self, kind: FlawKind, mut items: Vec<T>) -> std::vec::IntoIter<T> {
        if self.is(kind) {
            items.extend(items.first().copied());
        }
        items.into_iter()
    }

    /// Drops the last item if the flaw is `kind`.
    fn without_last<T>(&self, kind: FlawKind, mut items: Vec<T>) -> Vec<T> {
        if self.is(kind) {
            items.pop();
        }
        items
    }
}
