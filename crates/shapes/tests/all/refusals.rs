//! Invalid parameters return an error with their names.

use sixfold_core::PolygonMesh;
use sixfold_shapes::implicit::{Blob, Field};
use sixfold_shapes::{GENERATORS, ShapeError, generator};

/// Functions that build a shape from one parameter or from two.
type OneParameter = fn(usize) -> Result<PolygonMesh, ShapeError>;
type TwoParameters = fn(usize, usize) -> Result<PolygonMesh, ShapeError>;

#[test]
fn counts_out_of_range() {
    let around = 1 << 20;
    let side = 1 << 22;
    let one_parameter: [(&str, OneParameter, usize, usize); 5] = [
        ("n", sixfold_shapes::prism, 3, around),
        ("n", sixfold_shapes::antiprism, 3, around),
        ("n", sixfold_shapes::moebius, 3, around),
        ("frequency", sixfold_shapes::geodesic, 1, 5982),
        ("g", sixfold_shapes::genus, 0, side),
    ];
    for (parameter, make, min, max) in one_parameter {
        for value in (0..min).chain([max + 1, usize::MAX]) {
            let error = make(value).expect_err(parameter);
            assert_eq!(error, out_of_range(parameter, value as f64, min, max));
        }
    }
    let two_parameters: [(TwoParameters, [usize; 2], usize); 9] = [
        (sixfold_shapes::grid, [1, 1], side),
        (sixfold_shapes::triangle_grid, [1, 1], side),
        (sixfold_shapes::mixed_grid, [1, 1], side),
        (sixfold_shapes::grid_with_hole, [3, 3], side),
        (sixfold_shapes::triangle_tiling, [1, 1], side),
        (sixfold_shapes::hexagon_tiling, [1, 1], side),
        (sixfold_shapes::torus, [3, 3], around),
        (sixfold_shapes::triangle_torus, [3, 3], around),
        (sixfold_shapes::uv_sphere, [3, 2], around),
    ];
    for (make, [m, n], max) in two_parameters {
        for value in (0..m).chain([max + 1, usize::MAX]) {
            let error = make(value, n).expect_err("m");
            assert_eq!(error, out_of_range("m", value as f64, m, max));
        }
        for value in (0..n).chain([max + 1, usize::MAX]) {
            let error = make(m, value).expect_err("n");
            assert_eq!(error, out_of_range("n", value as f64, n, max));
        }
        // About 10¹² cells would take terabytes.
        let error = make(max, max).expect_err("too many");
        let ShapeError::TooManyCorners {
            parameters,
            corners,
            limit,
            ..
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!(parameters, [("m", max), ("n", max)]);
        assert!(corners > limit);
    }
}

fn out_of_range(parameter: &'static str, value: f64, min: usize, max: usize) -> ShapeError {
    ShapeError::OutOfRange {
        parameter,
        value,
        min: min as f64,
        max: max as f64,
    }
}

#[test]
fn messages_name_parameter_value_and_range() {
    let message = |made: Result<PolygonMesh, ShapeError>| made.expect_err("refused").to_string();
    assert_eq!(
        message(sixfold_shapes::torus(2, 5)),
        "m = 2 is out of range: choose a value from 3 to 1048576"
    );
    assert_eq!(
        message(sixfold_shapes::grid(40_000, 50_000)),
        "grid with m = 40000, n = 50000 has 8000000000 corners, more than 2147483647: choose smaller numbers"
    );
    let torus = generator("torus").expect("a shape");
    assert_eq!(
        message(torus.build(&[("m", 3.5)])),
        "m = 3.5 is not an integer: choose a whole number from 3 to 1048576"
    );
    assert_eq!(
        message(torus.build(&[("m", f64::NAN)])),
        "m = NaN is out of range: choose a value from 3 to 1048576"
    );
    assert_eq!(
        message(torus.build(&[("q", 3.0)])),
        "torus has no parameter \"q\": choose from m, n"
    );
    assert_eq!(
        message(torus.build(&[("m", 3.0), ("m", 4.0)])),
        "parameter m of torus is given twice: remove one"
    );
    let cube = generator("cube").expect("a shape");
    assert_eq!(
        message(cube.build(&[("n", 3.0)])),
        "cube has no parameter \"n\": it has no parameters"
    );
    let error = "spiral"
        .parse::<sixfold_shapes::Order>()
        .expect_err("no such order");
    let orders = "choose from given, shuffled, morton, breadth-first";
    assert_eq!(
        error.to_string(),
        format!("no order is called `spiral`: {orders}")
    );
}

#[test]
fn every_recipe_works_and_refuses() {
    let mut names: Vec<&str> = GENERATORS.iter().map(|generator| generator.name).collect();
    for generator in GENERATORS {
        let kebab = generator
            .name
            .bytes()
            .all(|b| b.is_ascii_lowercase() || b == b'-');
        assert!(kebab && !generator.summary.is_empty(), "{}", generator.name);
        assert_eq!(
            sixfold_shapes::generator(generator.name).map(|found| found.name),
            Some(generator.name)
        );
        let mesh = generator.build(&[]).expect(generator.name);
        assert!(mesh.face_count() > 0, "{}", generator.name);
        for parameter in generator.parameters {
            let with = |value| generator.build(&[(parameter.name, value)]);
            assert_eq!(
                with(parameter.default).as_ref(),
                Ok(&mesh),
                "{}",
                generator.name
            );
            // If the default of another parameter does not fit the minimum, the error names the
            // other parameter.
            if let Err(error) = with(parameter.min) {
                let other = matches!(error, ShapeError::OutOfRange { parameter: p, .. } if p != parameter.name);
                assert!(other, "{} {}: {error}", generator.name, parameter.name);
            }
            let beyond = [
                parameter.min - 1.0,
                parameter.max * 2.0,
                -1.0,
                1e300,
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
            ];
            for value in beyond {
                let error = with(value).expect_err(generator.name);
                let name = matches!(error, ShapeError::OutOfRange { parameter: p, .. } if p == parameter.name);
                assert!(
                    name,
                    "{} {} = {value}: {error}",
                    generator.name, parameter.name
                );
            }
            if parameter.is_integer {
                let error = with(parameter.default + 0.5).expect_err(generator.name);
                assert!(matches!(error, ShapeError::NotInteger { .. }), "{error}");
            }
        }
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), GENERATORS.len());
    assert!(sixfold_shapes::generator("teapot").is_none());
}

#[test]
fn invalid_fields_and_empty_solids() {
    let nan = f64::NAN;
    assert!(Field::sphere([nan, 0.0, 0.0], 1.0).is_err());
    assert!(Field::sphere([0.0; 3], 0.0).is_err());
    assert!(Field::sphere([0.0; 3], f64::INFINITY).is_err());
    assert!(Field::torus([0.0; 3], [0.0; 3], 1.0, 0.2).is_err());
    assert!(Field::torus([0.0; 3], [0.0, 0.0, 1.0], nan, 0.2).is_err());
    assert!(Field::cuboid([0.0; 3], [1.0, -1.0, 1.0]).is_err());
    let ball = || Field::sphere([0.0; 3], 1.0).expect("a ball");
    assert!(ball().smooth_union(ball(), -0.1).is_err());
    assert!(ball().smooth_union(ball(), nan).is_err());
    assert!(ball().inflated(nan).is_err());
    let blob = Blob {
        centre: [0.0; 3],
        strength: 1.0,
        sharpness: 1.0,
    };
    assert!(Field::blobs(&[blob], 0.0).is_err());
    assert!(
        Field::blobs(
            &[Blob {
                sharpness: 0.0,
                ..blob
            }],
            0.5
        )
        .is_err()
    );

    for faces in [0, 99, 4_000_001, usize::MAX] {
        let error = ball().polygonised(faces).expect_err("faces");
        assert!(
            matches!(
                error,
                ShapeError::OutOfRange {
                    parameter: "faces",
                    ..
                }
            ),
            "{error}"
        );
    }
    let bells = || Field::blobs(&[blob], 0.5).expect("a blob");
    assert_eq!(
        bells().inflated(0.5).and_then(|f| f.polygonised(500)),
        Err(ShapeError::Unbounded)
    );
    let far = Field::sphere([10.0, 0.0, 0.0], 1.0).expect("a ball");
    let empty_solids = [
        ball().intersection(far).expect("two parts"),
        ball().difference(ball()).expect("two parts"),
        ball().inflated(-2.0).expect("an empty solid"),
        ball().inflated(-1.0).expect("a point"),
        Field::blobs(&[blob], 2.0).expect("a level that is never reached"),
        Field::blobs(&[], 1.0).expect("no blobs"),
    ];
    for field in empty_solids {
        assert_eq!(field.polygonised(500), Err(ShapeError::Empty), "{field:?}");
    }
    let distant = Field::sphere([1e6, 0.0, 0.0], 0.01).expect("small and far away");
    let error = distant
        .polygonised(500)
        .expect_err("too fine for f32 so far from the origin");
    assert!(matches!(error, ShapeError::TooFine { .. }), "{error}");

    // A long chain would overflow the stack. The same parts in pairs are accepted.
    let chain = (0..10_000).try_fold(ball(), |chain, _| chain.union(ball()));
    let error = chain.expect_err("too deep");
    assert_eq!(error, out_of_range("depth", 501.0, 1, 500));
    let mut parts: Vec<Field> = vec![ball(); 1 << 10];
    while parts.len() > 1 {
        let pairs = parts
            .chunks(2)
            .map(|pair| pair[0].clone().union(pair[1].clone()));
        parts = pairs.collect::<Result<_, _>>().expect("ten deep");
    }
    assert!(parts[0].at([0.0; 3]) < 0.0);
    let deepest = (1..500).try_fold(ball(), |chain, _| chain.union(ball()));
    assert!(deepest.and_then(|field| field.polygonised(200)).is_ok());
}
