use sixfold_core::FaceList;

use super::*;

fn faces(lists: &[&[u32]]) -> ScannedFaces<VertexId> {
    let mut faces = FaceList::default();
    for list in lists {
        let face = list.iter().copied().map(VertexId::new);
        faces.push(face).expect("small");
    }
    ScannedFaces::new(faces.corners().to_vec(), faces.spans())
}

#[test]
fn a_scan_finds_what_a_search_finds_at_every_block_boundary() {
    for count in [1, 20, 21, 22, 42, 43, 64, 65] {
        let strip: Vec<[u32; 3]> = (0..count).map(|f| [f, f + 1, f + 2]).collect();
        let strip: Vec<&[u32]> = strip.iter().map(|face| &face[..]).collect();
        let mesh = faces(&strip);
        let v = |i: u32| VertexId::new(i % (count + 2));
        for i in 0..count + 2 {
            let some = [i, i + 7, i + 1, i + 30, i + 31, i + 2].map(v);
            for wanted in (1..=some.len()).map(|n| &some[..n]) {
                let all = 0..mesh.corners.len();
                let expected = all.filter(|&c| wanted.contains(&mesh.corners.rows()[c]));
                assert!(
                    mesh.scan(SearchSet::from_vertices(wanted)).eq(expected),
                    "{wanted:?} of {count} faces"
                );
            }
        }
    }
}

#[test]
fn every_side_ends_at_one_of_every_second_corner() {
    let face: Vec<VertexId> = (0..20).map(VertexId::new).collect();
    for degree in 3..=face.len() {
        let face = &face[..degree];
        let hits = SearchSet::<VertexId, _>::every_second(face).hits(face);
        let is_hit = |v: VertexId| hits >> v.index() & 1 == 1;
        let mut sides = Pair::sides(degree, |i| face[i]).map(Pair::ends);
        assert!(
            sides.all(|[a, b]| is_hit(a) || is_hit(b)),
            "degree {degree}"
        );
        let expected = degree.div_ceil(2);
        assert_eq!(hits.count_ones() as usize, expected, "degree {degree}");
    }
}

#[test]
fn scans_skip_blank_corners() {
    let mut mesh = ScannedFaces::from(faces(&[&[0, 1, 2, 3], &[2, 1, 4], &[0, 3, 5]]));
    let f = FaceId::new;
    mesh.spans.rewrite(
        &mut mesh.corners,
        f(0),
        &[0, 1, 2].map(VertexId::new),
        VertexId::BLANK,
    );
    mesh.spans.blank(&mut mesh.corners, f(1), VertexId::BLANK);
    assert!(mesh.check_holes().is_err(), "blank, but no hole");
    mesh.holes.insert(1);
    assert_eq!(mesh.check_holes(), Ok(()));
    let blank = VertexId::BLANK;
    for other in [VertexId::new(0), blank] {
        let e = Pair::new(other, blank);
        assert_eq!(mesh.edge_faces(e).next(), None);
        assert_eq!(mesh.edge_edges(e).next(), None);
    }
    let many: Vec<VertexId> = (0..6).map(VertexId::new).collect();
    assert_eq!(mesh.scan(SearchSet::from_vertices(&many)).count(), 6);
    mesh.corners.rows_mut()[3] = many[3];
    let wrong = mesh.check_holes().unwrap_err();
    assert_eq!(wrong, "corner 3 is not blank, but no face has it");
}

#[test]
#[should_panic(expected = "no face f1: it was deleted")]
fn a_deleted_face_panics_with_its_handle() {
    let mut mesh = ScannedFaces::from(faces(&[&[0, 1, 2, 3], &[2, 1, 4]]));
    mesh.spans
        .blank(&mut mesh.corners, FaceId::new(1), VertexId::BLANK);
    mesh.holes.insert(1);
    mesh.face(FaceId::new(1));
}
