use super::*;
use crate::polygons::face_list::faces_of_degrees as list;
use crate::tables::holes::HoleSet;
use crate::tables::holes::Holes;

#[test]
#[should_panic(expected = "no face f2: every face has a row below 2")]
fn a_missing_face_panics_with_its_handle() {
    list(&[3, 3]).spans().range(FaceId::new(2));
}

#[test]
#[should_panic(expected = "no face f2: every face has a row below 2")]
fn a_missing_face_panics_with_its_handle_if_degrees_are_mixed() {
    list(&[3, 4]).spans().range(FaceId::new(2));
}

#[test]
fn around_returns_the_face_and_the_corners_before_and_after() {
    for degrees in [&[3, 3, 3][..], &[4, 3, 5], &[3, 3, 4, 3, 6, 3]] {
        let spans = list(degrees).spans();
        let faces = (0..row(degrees.len())).map(FaceId::new);
        for (face, corners) in faces.map(|f| (f, spans.range(f))) {
            let (first, last) = (corners.start, corners.end - 1);
            assert_eq!(spans.around(first), (face, [last, first, first + 1]));
            assert_eq!(spans.around(last), (face, [last - 1, last, first]));
            for corner in first + 1..last {
                let around = [corner - 1, corner, corner + 1];
                assert_eq!(spans.around(corner), (face, around));
                assert_eq!(spans.face_of(corner), face);
            }
        }
    }
}

#[test]
fn spans_must_divide_the_corners() {
    assert_eq!(list(&[3, 4]).spans().check(7), Ok(()));
    assert!(list(&[3, 4]).spans().check(8).is_err());
    assert!(list(&[3, 4]).spans().check(6).is_err());
    assert!(list(&[3, 3]).spans().check(5).is_err());
    assert!(list(&[3, 2]).spans().check(5).is_err());
}

const BLANK: u32 = 99;

fn faces(
    spans: &FaceSpans<Untraced, Editable>,
    corners: &Table<u32>,
    holes: &Holes,
) -> Vec<Vec<u32>> {
    assert_eq!(spans.check(corners.len()), Ok(()));
    let live = holes.handles(spans.len());
    let live = live.map(|f| corners.rows()[spans.range(f)].to_vec());
    live.collect()
}

#[test]
fn faces_are_added_rewritten_deleted_and_compacted() {
    for degrees in [&[][..], &[3, 3, 3], &[4, 3, 5], &[4, 4]] {
        let mut spans = FaceSpans::from(list(degrees).spans());
        let all: Vec<Vec<u32>> = degrees.iter().map(|&d| (10..10 + d).collect()).collect();
        let mut corners = Table::new("corners", "corner", all.concat());
        let mut holes = Holes::new("face holes");
        let mut expected = all.clone();
        for new in [&[1, 2, 3][..], &[4, 5, 6], &[1, 2, 3, 4, 5], &[7, 8, 9]] {
            let f = spans.push(&mut corners, new);
            expected.push(new.to_vec());
            assert_eq!(f.index() + 1, expected.len());
            assert_eq!(faces(&spans, &corners, &holes), expected);
        }
        for (f, new) in [
            (0, &[1, 2, 3][..]),
            (1, &[1, 2, 3, 4, 5, 6, 7]),
            (2, &[3, 2, 1]),
            (1, &[5, 6, 7, 8]),
            (1, &[1, 2, 3, 4, 5, 6, 7, 8, 9]),
        ] {
            spans.rewrite(&mut corners, FaceId::new(f), new, BLANK);
            expected[f as usize] = new.to_vec();
            assert_eq!(faces(&spans, &corners, &holes), expected);
            for corner in (0..corners.len()).filter(|&c| corners.rows()[c] != BLANK) {
                let f = spans.face_of(corner);
                assert!(spans.range(f).contains(&corner));
            }
        }
        for f in [1, 0, 3] {
            spans.blank(&mut corners, FaceId::new(f), BLANK);
            holes.insert(f as usize);
        }
        expected = [&expected[2..3], &expected[4..]].concat();
        assert_eq!(faces(&spans, &corners, &holes), expected);
        spans.compact(&mut corners, &holes);
        holes.clear();
        assert_eq!(faces(&spans, &corners, &holes), expected);
        assert!(corners.rows().iter().all(|&c| c != BLANK));
        assert!(!matches!(spans, FaceSpans::Scattered(_)));
        let is_uniform = expected.iter().all(|f| f.len() == expected[0].len());
        assert_eq!(matches!(spans, FaceSpans::Uniform { .. }), is_uniform);
    }
}

#[test]
fn a_uniform_degree_stays_uniform() {
    let mut spans = FaceSpans::from(list(&[3, 3, 3]).spans());
    let mut corners = Table::new("corners", "corner", (0..9).collect());
    let mut holes = Holes::new("face holes");
    spans.rewrite(&mut corners, FaceId::new(1), &[7, 7, 7], BLANK);
    spans.push(&mut corners, &[1, 2, 3]);
    spans.blank(&mut corners, FaceId::new(0), BLANK);
    holes.insert(0);
    spans.compact(&mut corners, &holes);
    holes.clear();
    assert!(matches!(
        spans,
        FaceSpans::Uniform {
            degree: 3,
            faces: 3
        }
    ));
    assert_eq!(
        faces(&spans, &corners, &holes),
        [[7, 7, 7], [6, 7, 8], [1, 2, 3]]
    );
}
