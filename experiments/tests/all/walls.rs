//! The walls: their exact integrals, and the documented properties of each method.

use experiments::walls::{
    Case, Integrals, METHODS, Method, Particles, Place, Region, SUPPORT_RADIUS, Stored, TABLES,
    Volumes, cases, measure,
};
use sandbox::engine::boundary::WallMethod;
use sandbox::engine::geometry::{Polygon, Walls};
use sandbox::engine::kernel;
use sandbox::engine::math::Vector;

const PLACES: usize = 40;

fn vector(x: f64, y: f64) -> Vector {
    Vector::new(x, y)
}

fn rectangle(x: [f64; 2], y: [f64; 2]) -> Polygon {
    let corners = [(0, 0), (1, 0), (1, 1), (0, 1)];
    Polygon::new(corners.map(|(i, j)| vector(x[i], y[j])).into()).unwrap()
}

fn exact(region: Region, case: &Case) -> Vec<Integrals> {
    let places = case.places.iter().map(|place| place.position);
    places
        .map(|r_i| Integrals::over(region, &case.walls, r_i, SUPPORT_RADIUS, 1e-12))
        .collect()
}

fn found(method: Method, case: &Case) -> Vec<Integrals> {
    let (mut integrals, _) = method.prepare(case);
    let places = case.places.iter().map(|place| place.position);
    places.map(&mut integrals).collect()
}

/// The larger of the root-mean-square errors of density and force over the path.
fn error(method: Method, case: &Case, exact: &[Integrals]) -> f64 {
    let mean = |of: fn(Integrals) -> f64| {
        let differences = found(method, case)
            .into_iter()
            .zip(exact)
            .map(|(f, e)| of(f - *e));
        (differences.map(|d| d * d).sum::<f64>() / exact.len() as f64).sqrt()
    };
    mean(|d| d.kernel).max(mean(|d| d.gradient.norm()))
}

#[test]
fn every_path_lies_on_free_floor_near_walls() {
    for case in cases(PLACES) {
        assert_eq!(case.places.len(), PLACES);
        let free = |place: &Place| case.walls.obstacle_at(place.position).is_none();
        assert!(case.places.iter().all(free), "{}", case.name);
        let hidden = exact(Region::Hidden, &case);
        assert!(
            hidden.iter().any(|hidden| hidden.kernel > 0.05),
            "{}",
            case.name
        );
    }
}

#[test]
fn the_solid_integrals_agree_with_a_sum_over_small_squares() {
    for case in cases(5) {
        let solid = exact(Region::Solid, &case);
        for (place, solid) in case.places.iter().zip(solid) {
            let steps = 400;
            let cell = 2.0 * SUPPORT_RADIUS / f64::from(steps);
            let squares = (0..steps * steps).map(|k| {
                let x = vector(f64::from(k % steps) + 0.5, f64::from(k / steps) + 0.5) * cell
                    - vector(SUPPORT_RADIUS, SUPPORT_RADIUS);
                let counts = x.norm() < SUPPORT_RADIUS
                    && case.walls.obstacle_at(place.position + x).is_some();
                let area = if counts { cell * cell } else { 0.0 };
                Integrals::of_piece(x, area, SUPPORT_RADIUS)
            });
            let difference = solid.distance(&squares.sum());
            assert!(difference < 1e-2, "{} {place:?}: {difference}", case.name);
        }
    }
}

#[test]
fn a_thin_wall_hides_a_half_plane_and_is_the_difference_of_two_half_planes() {
    let walls = cases(PLACES).into_iter();
    for mut case in walls.filter(|case| case.name == "wall of 1 cm") {
        let [hidden, solid] = [Region::Hidden, Region::Solid].map(|region| exact(region, &case));
        let normal = case.walls.iter().map(|wall| wall.normal);
        let normal = normal.max_by(|a, b| a.y.total_cmp(&b.y)).unwrap();
        for place in &mut case.places {
            place.position += normal * 0.01;
        }
        let farther = exact(Region::Hidden, &case);
        for ((hidden, solid), farther) in hidden.iter().zip(&solid).zip(&farther) {
            assert!(solid.distance(&(*hidden - *farther)) < 1e-11);
        }
    }
}

#[test]
fn the_union_is_the_hidden_region_and_exact_exceeds_it_only_where_shadows_overlap() {
    for case in cases(PLACES) {
        let hidden = exact(Region::Hidden, &case);
        let union = found(Method::Polygons(WallMethod::Union), &case);
        let sum = found(Method::Polygons(WallMethod::Exact), &case);
        for ((union, sum), hidden) in union.iter().zip(&sum).zip(&hidden) {
            assert!(
                union.distance(hidden) < 1e-10,
                "{} {union:?} {hidden:?}",
                case.name
            );
            assert!(sum.kernel > hidden.kernel - 1e-10, "{}", case.name);
        }
        let more = sum
            .iter()
            .zip(&hidden)
            .map(|(s, h)| s.distance(h))
            .fold(0.0, f64::max);
        let overlaps = case.name == "barrier before a wall";
        assert!(
            if overlaps { more > 0.01 } else { more < 1e-10 },
            "{} {more}",
            case.name
        );
    }
}

#[test]
fn in_front_of_an_infinite_wall_every_polygon_method_gives_the_printed_values() {
    let place = |along: f64| Place {
        along,
        position: vector(0.3, along),
    };
    let case = Case {
        name: "straight wall",
        axis: "distance [m]",
        walls: Walls::new(vec![rectangle([-3.0, 3.0], [-2.0, 0.0])]),
        places: [0.24, 0.5].map(place).to_vec(),
        tangent: None,
    };
    let (truth, point) = (
        [[0.23860, 0.94868], [0.05865, 0.27759]],
        [[0.32538, 1.51053], [0.06549, 0.36656]],
    );
    let assert_is = |found: Vec<Integrals>, printed: [[f64; 2]; 2]| {
        for (found, [kernel, gradient]) in found.iter().zip(printed) {
            assert!((found.kernel - kernel).abs() < 5.1e-6, "{found:?}");
            assert!(
                (found.gradient.norm() - gradient).abs() < 5.1e-6,
                "{found:?}"
            );
            assert!(found.gradient.y < 0.0);
        }
    };
    assert_is(exact(Region::Hidden, &case), truth);
    assert_is(exact(Region::Solid, &case), truth);
    assert_is(found(Method::Polygons(WallMethod::Exact), &case), truth);
    assert_is(found(Method::Polygons(WallMethod::Union), &case), truth);
    assert_is(
        found(Method::Polygons(WallMethod::Representative), &case),
        point,
    );
}

/// Orders of convergence between the spacings `coarse`, `coarse / 2` and `coarse / 4`.
fn orders(case: &Case, coarse: f64, method: impl Fn(f64) -> Method) -> [f64; 2] {
    let exact = exact(Region::Solid, case);
    let [a, b, c] = [1.0, 0.5, 0.25].map(|part| error(method(part * coarse), case, &exact));
    [(a / b).log2(), (b / c).log2()]
}

/// The paths that stay at least a body radius away from all walls. Closer to a wall, the cusp of the force kernel
/// reaches the solid.
fn off_the_walls() -> impl Iterator<Item = Case> {
    let cases = cases(PLACES).into_iter();
    cases.filter(|case| case.tangent.is_none())
}

#[test]
fn particles_in_cut_cells_converge_to_the_solid_with_order_two() {
    for case in off_the_walls() {
        let found = orders(&case, 0.2, |spacing| {
            Method::Particles(Volumes::Cut, spacing)
        });
        assert!(
            found.iter().all(|order| *order > 1.5),
            "{} {found:?}",
            case.name
        );
    }
}

#[test]
fn particles_in_whole_cells_converge_with_larger_errors_than_in_cut_cells() {
    for case in off_the_walls() {
        let exact = exact(Region::Solid, &case);
        let error = |spacing, volumes| {
            let method = Method::Particles(volumes, spacing);
            error(method, &case, &exact)
        };
        let [coarse, fine] = [0.2, 0.05].map(|spacing| error(spacing, Volumes::Whole));
        assert!(fine < 0.5 * coarse, "{} {coarse} {fine}", case.name);
        assert!(error(0.1, Volumes::Cut) < error(0.1, Volumes::Whole));
    }
}

#[test]
fn a_map_of_integrals_converges_to_the_solid_with_order_two() {
    for case in off_the_walls() {
        let found = orders(&case, 0.2, |spacing| {
            Method::Map(Stored::Integrals, spacing)
        });
        assert!(
            found.iter().all(|order| *order > 1.5),
            "{} {found:?}",
            case.name
        );
    }
}

#[test]
fn a_volume_map_puts_the_whole_solid_at_the_nearest_point() {
    let straight = cases(PLACES).into_iter().next().unwrap();
    let map = Method::Map(Stored::Volume, 0.02);
    let solid = exact(Region::Solid, &straight);
    for ((place, solid), found) in straight.places.iter().zip(solid).zip(found(map, &straight)) {
        let weight = kernel::density(place.along * place.along, SUPPORT_RADIUS);
        assert!(
            (found.kernel - solid.area * weight).abs() < 2e-3,
            "{place:?}"
        );
    }
}

#[test]
fn particles_with_akinci_volumes_are_right_inside_a_solid_and_too_dense_at_its_surface() {
    let solid = Walls::new(vec![rectangle([-2.5, 2.5], [-4.0, 0.0])]);
    let density = |volumes, y: f64| {
        let particles = Particles::fill(&solid, 0.1, volumes, 1.0);
        particles.integrals(vector(0.017, y)).kernel
    };
    for volumes in [Volumes::Whole, Volumes::Cut, Volumes::Akinci] {
        assert!((density(volumes, -2.0) - 1.0).abs() < 1e-3);
    }
    assert!((density(Volumes::Cut, 0.0) - 0.5).abs() < 0.01);
    assert!(density(Volumes::Akinci, 0.0) > 0.65);
}

#[test]
fn the_report_has_every_method_on_every_path() {
    let report = measure(true);
    let paths = cases(2).len();
    assert_eq!(report.cases.len(), paths);
    let findings = report.findings().unwrap();
    let csv = String::from_utf8(findings.tables[0].1.clone()).unwrap();
    let text = findings.document.text();
    assert_eq!(csv.lines().count(), 1 + paths * METHODS.len());
    for case in &report.cases {
        assert!(case.quadrature < 1e-9);
        for method in &case.methods {
            assert!(method.density.rms <= method.density.max && method.density.max.is_finite());
            assert!(method.force.rms <= method.force.max && method.force.max.is_finite());
            assert!(method.ns.minimum > 0.0 && method.preparation_ms >= 0.0);
            assert!(text.contains(&method.name));
        }
        for method in &case.methods[1..3] {
            assert!(
                method
                    .roughness
                    .is_none_or(|roughness| roughness.max < 1e-12)
            );
        }
    }
    let json = serde_json::to_value(&report).unwrap();
    assert_eq!(json["cases"][0]["methods"][0]["region"], "hidden");
}

#[test]
fn results_are_replaced_only_with_force_and_the_tables_go_into_a_document() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let (out, document) = (path("results"), path("document.md"));
    std::fs::write(
        &document,
        format!("<!-- {TABLES} -->\n<!-- /{TABLES} -->\n"),
    )
    .unwrap();
    let [out_text, document_text] = [&out, &document].map(|path| path.to_str().unwrap());
    let arguments = [
        "walls",
        "--quick",
        "--out",
        out_text,
        "--update",
        document_text,
    ];
    let run = |more: &[&str]| crate::run(&[&arguments[..], more].concat());
    assert_eq!(run(&[]).status.code(), Some(0));
    let read =
        |extension: &str| std::fs::read_to_string(out.join(format!("walls.{extension}"))).unwrap();
    for extension in ["md", "svg"] {
        assert!(read(extension).contains("volume map"), "{extension}");
    }
    let json: serde_json::Value = serde_json::from_str(&read("json")).unwrap();
    assert!(read("csv").lines().count() > 1 && !json.as_object().unwrap().is_empty());
    assert!(
        std::fs::read(out.join("walls.png"))
            .unwrap()
            .starts_with(b"\x89PNG")
    );
    let text = std::fs::read_to_string(&document).unwrap();
    assert!(text.contains("volume map"), "{text}");
    let again = run(&[]);
    assert_eq!(again.status.code(), Some(2));
    let said = String::from_utf8(again.stderr).unwrap();
    assert!(
        said.contains("walls.json") && said.contains("--force"),
        "{said}"
    );
    assert_eq!(run(&["--force"]).status.code(), Some(0));
}

#[test]
fn a_document_without_a_place_for_the_tables_is_refused_before_anything_is_measured() {
    let folder = tempfile::tempdir().unwrap();
    let document = folder.path().join("document.md");
    std::fs::write(&document, "no place\n").unwrap();
    let output = crate::run(&["walls", "--update", document.to_str().unwrap()]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.contains("<!-- wall-integrals -->"), "{said}");
}
