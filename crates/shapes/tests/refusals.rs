//! Impossible parameters are refused by name, before anything is allocated.

use mesh_core::PolygonMesh;
use shapes::implicit::{Blob, Field};
use shapes::{RECIPES, ShapeError, recipe};

/// A shape with one parameter, or with two.
type One = fn(usize) -> Result<PolygonMesh, ShapeError>;
type Two = fn(usize, usize) -> Result<PolygonMesh, ShapeError>;

#[test]
fn counts_out_of_range() {
    let around = 1 << 20;
    let side = 1 << 22;
    let ones: [(&str, One, usize, usize); 5] = [
        ("n", shapes::prism, 3, around),
        ("n", shapes::antiprism, 3, around),
        ("n", shapes::moebius, 3, around),
        ("frequency", shapes::geodesic, 1, 5982),
        ("g", shapes::genus, 0, side),
    ];
    for (parameter, make, least, greatest) in ones {
        for value in (0..least).chain([greatest + 1, usize::MAX]) {
            let error = make(value).expect_err(parameter);
            assert_eq!(
                error,
                out_of_range(parameter, value as f64, least, greatest)
            );
        }
    }
    let twos: [(Two, [usize; 2], usize); 9] = [
        (shapes::grid, [1, 1], side),
        (shapes::triangle_grid, [1, 1], side),
        (shapes::mixed_grid, [1, 1], side),
        (shapes::grid_with_hole, [3, 3], side),
        (shapes::triangle_tiling, [1, 1], side),
        (shapes::hexagon_tiling, [1, 1], side),
        (shapes::torus, [3, 3], around),
        (shapes::triangle_torus, [3, 3], around),
        (shapes::uv_sphere, [3, 2], around),
    ];
    for (make, [m, n], greatest) in twos {
        for value in (0..m).chain([greatest + 1, usize::MAX]) {
            let error = make(value, n).expect_err("m");
            assert_eq!(error, out_of_range("m", value as f64, m, greatest));
        }
        for value in (0..n).chain([greatest + 1, usize::MAX]) {
            let error = make(m, value).expect_err("n");
            assert_eq!(error, out_of_range("n", value as f64, n, greatest));
        }
        // Each alone is allowed: some 10¹² cells would take terabytes.
        let error = make(greatest, greatest).expect_err("too many");
        let ShapeError::TooMany {
            parameters,
            corners,
            limit,
            ..
        } = error
        else {
            panic!("{error}");
        };
        assert_eq!(parameters, [("m", greatest), ("n", greatest)]);
        assert!(corners > limit);
    }
}

fn out_of_range(parameter: &'static str, value: f64, least: usize, greatest: usize) -> ShapeError {
    ShapeError::OutOfRange {
        parameter,
        value,
        least: least as f64,
        greatest: greatest as f64,
    }
}

#[test]
fn messages_name_parameter_value_and_range() {
    let message = |made: Result<PolygonMesh, ShapeError>| made.expect_err("refused").to_string();
    assert_eq!(
        message(shapes::torus(2, 5)),
        "m = 2: choose from 3 to 1048576"
    );
    assert_eq!(
        message(shapes::grid(40_000, 50_000)),
        "grid with m = 40000, n = 50000 has 8000000000 corners, beyond 2147483647: choose smaller numbers"
    );
    let torus = recipe("torus").expect("a shape");
    assert_eq!(
        message(torus.make(&[("m", 3.5)])),
        "m = 3.5: choose a whole number from 3 to 1048576"
    );
    assert_eq!(
        message(torus.make(&[("m", f64::NAN)])),
        "m = NaN: choose from 3 to 1048576"
    );
    assert_eq!(
        message(torus.make(&[("q", 3.0)])),
        "torus has no parameter \"q\": choose from m, n"
    );
    assert_eq!(
        message(torus.make(&[("m", 3.0), ("m", 4.0)])),
        "torus is given m twice: leave one out"
    );
    let cube = recipe("cube").expect("a shape");
    assert_eq!(
        message(cube.make(&[("n", 3.0)])),
        "cube has no parameter \"n\": it takes none"
    );
    let error = "spiral"
        .parse::<shapes::Order>()
        .expect_err("no such order");
    let orders = "choose from given, shuffled, morton, breadth-first";
    assert_eq!(
        error.to_string(),
        format!("no order is called \"spiral\": {orders}")
    );
}

#[test]
fn every_recipe_works_and_refuses() {
    let mut names: Vec<&str> = RECIPES.iter().map(|recipe| recipe.name).collect();
    for recipe in RECIPES {
        let kebab = recipe
            .name
            .bytes()
            .all(|b| b.is_ascii_lowercase() || b == b'-');
        assert!(kebab && !recipe.summary.is_empty(), "{}", recipe.name);
        assert_eq!(
            shapes::recipe(recipe.name).map(|found| found.name),
            Some(recipe.name)
        );
        let mesh = recipe.make(&[]).expect(recipe.name);
        assert!(mesh.face_count() > 0, "{}", recipe.name);
        for parameter in recipe.parameters {
            let with = |value| recipe.make(&[(parameter.name, value)]);
            assert_eq!(
                with(parameter.default).as_ref(),
                Ok(&mesh),
                "{}",
                recipe.name
            );
            // The least may be too little for the default of another parameter, which then is named.
            if let Err(error) = with(parameter.least) {
                let other = matches!(error, ShapeError::OutOfRange { parameter: p, .. } if p != parameter.name);
                assert!(other, "{} {}: {error}", recipe.name, parameter.name);
            }
            let beyond = [
                parameter.least - 1.0,
                parameter.greatest * 2.0,
                -1.0,
                1e300,
                f64::NAN,
                f64::INFINITY,
                f64::NEG_INFINITY,
            ];
            for value in beyond {
                let error = with(value).expect_err(recipe.name);
                let name = matches!(error, ShapeError::OutOfRange { parameter: p, .. } if p == parameter.name);
                assert!(
                    name,
                    "{} {} = {value}: {error}",
                    recipe.name, parameter.name
                );
            }
            if parameter.whole {
                let error = with(parameter.default + 0.5).expect_err(recipe.name);
                assert!(matches!(error, ShapeError::NotWhole { .. }), "{error}");
            }
        }
    }
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), RECIPES.len());
    assert!(shapes::recipe("teapot").is_none());
}

#[test]
fn fields_that_make_no_solid() {
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
    let nothing = [
        ball().intersection(far).expect("two parts"),
        ball().difference(ball()).expect("two parts"),
        ball().inflated(-2.0).expect("less than nothing"),
        ball().inflated(-1.0).expect("a point"),
        Field::blobs(&[blob], 2.0).expect("a level never reached"),
        Field::blobs(&[], 1.0).expect("no blobs"),
    ];
    for field in nothing {
        assert_eq!(
            field.polygonised(500),
            Err(ShapeError::Nothing),
            "{field:?}"
        );
    }
    let distant = Field::sphere([1e6, 0.0, 0.0], 0.01).expect("small and far away");
    let error = distant
        .polygonised(500)
        .expect_err("f32 has no such places");
    assert!(matches!(error, ShapeError::TooFine { .. }), "{error}");

    // A chain too long for the stack ends in an error; the same parts in pairs are fine.
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
