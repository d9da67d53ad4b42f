//! Errors and costs of every method on every path.

use std::hint::black_box;
use std::time::Instant;

use super::integrals::{Integrals, Region};
use sandbox::analysis::statistics::Range;
use sandbox::engine::math::Vector;
use serde::Serialize;

use super::{Case, METHODS, Method, Prepared, SUPPORT_RADIUS, cases};

/// Tolerances of the exact integrals, and of those that they are checked against.
const TOLERANCE: f64 = 1e-13;
const COARSER_TOLERANCE: f64 = 1e-9;

/// An error, relative to the largest exact value of the case.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Error {
    /// Root mean square over the places.
    pub rms: f64,
    /// At the worst place.
    pub max: f64,
}

impl Error {
    /// The error of `differences`, relative to `largest`.
    pub fn of(differences: impl Iterator<Item = f64>, largest: f64) -> Self {
        let (mut count, mut squares, mut max) = (0, 0.0, 0.0_f64);
        for difference in differences {
            count += 1;
            squares += difference * difference;
            max = max.max(difference.abs());
        }
        let rms = (squares / f64::from(count.max(1))).sqrt();
        Self {
            rms: rms / largest,
            max: max / largest,
        }
    }
}

/// The results of one method on one path.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MethodReport {
    /// The method.
    pub name: String,
    /// The region of the exact integrals that it is measured against.
    pub region: Region,
    /// Error of ∫ W.
    pub density: Error,
    /// Error of ∫ ∇W, as a vector.
    pub force: Error,
    /// Error of the force along an endless straight wall, which should be 0: the roughness of the wall.
    pub roughness: Option<Error>,
    /// Nanoseconds per evaluation, including the search for walls.
    pub ns: Range,
    /// Time before the first frame, milliseconds: the median of several measurements.
    pub preparation_ms: f64,
    /// Memory in addition to the polygons, bytes.
    pub bytes: usize,
    /// ∫ W and |∫ ∇W| (1/m) at each place.
    pub curve: Vec<[f64; 2]>,
}

/// The results on one path.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CaseReport {
    /// The name of the case.
    pub name: &'static str,
    /// The meaning of `along`.
    pub axis: &'static str,
    /// The x value of the curves, meters, place by place.
    pub along: Vec<f64>,
    /// ∫ W and |∫ ∇W| (1/m) over the hidden region.
    pub hidden: Vec<[f64; 2]>,
    /// The same over the solid.
    pub solid: Vec<[f64; 2]>,
    /// Difference of the solid's density from that of the hidden region, relative to the largest of the latter.
    pub solid_density: Error,
    /// The same for the force.
    pub solid_force: Error,
    /// Largest change of all these integrals with a tolerance ten thousand times larger.
    pub quadrature: f64,
    /// Nanoseconds to find the walls within reach, which the polygons' times include.
    pub search_ns: Range,
    /// The methods in the order of [`METHODS`].
    pub methods: Vec<MethodReport>,
}

/// All results.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WallReport {
    /// Few places and few turns: the times are meaningless.
    pub quick: bool,
    /// The results, path by path.
    pub cases: Vec<CaseReport>,
}

/// Measures every method on every path.
pub fn measure(quick: bool) -> WallReport {
    // Turns of all methods, and passes of a method along the path in each turn.
    let (places, effort) = if quick { (10, [3, 2]) } else { (50, [7, 40]) };
    let cases = cases(places);
    WallReport {
        quick,
        cases: cases.iter().map(|case| of_case(case, effort)).collect(),
    }
}

fn of_case(case: &Case, [turns, passes]: [usize; 2]) -> CaseReport {
    let exact = |region, tolerance| -> Vec<Integrals> {
        let places = case.places.iter().map(|place| place.position);
        let over = |r_i| Integrals::over(region, &case.walls, r_i, SUPPORT_RADIUS, tolerance);
        places.map(over).collect()
    };
    let [hidden, solid] = [Region::Hidden, Region::Solid].map(|region| exact(region, TOLERANCE));
    let coarser = [Region::Hidden, Region::Solid].map(|region| exact(region, COARSER_TOLERANCE));
    let changes = hidden.iter().chain(&solid).zip(coarser.iter().flatten());
    let [solid_density, solid_force] = errors(&solid, &hidden);

    let mut prepared: Vec<Prepared> = METHODS.map(|method| method.prepare(case)).into();
    let mut ns = vec![Vec::with_capacity(turns); METHODS.len()];
    for _ in 0..turns {
        for (method, ns) in prepared.iter_mut().zip(&mut ns) {
            ns.push(ns_per_place(case, passes, |r_i| {
                black_box((method.0)(r_i));
            }));
        }
    }
    let methods = METHODS.into_iter().zip(&mut prepared).zip(&ns);
    let methods = methods.map(|((method, prepared), ns)| {
        let exact = match method.region() {
            Region::Hidden => &hidden,
            Region::Solid => &solid,
        };
        let times = (Range::of(ns), preparation_ms(method, case, turns));
        of_method(method, prepared, (case, exact), times)
    });
    let mut near = Vec::new();
    let search = |_| {
        ns_per_place(case, passes, |r_i| {
            near.clear();
            case.walls.near(r_i, SUPPORT_RADIUS, &mut near);
            black_box(&near);
        })
    };
    CaseReport {
        name: case.name,
        axis: case.axis,
        along: case.places.iter().map(|place| place.along).collect(),
        hidden: curve(&hidden),
        solid: curve(&solid),
        solid_density,
        solid_force,
        quadrature: changes.map(|(a, b)| a.distance(b)).fold(0.0, f64::max),
        methods: methods.collect(),
        search_ns: Range::of(&(0..turns).map(search).collect::<Vec<_>>()),
    }
}

fn of_method(
    method: Method,
    prepared: &mut Prepared,
    (case, exact): (&Case, &[Integrals]),
    (ns, preparation_ms): (Range, f64),
) -> MethodReport {
    let places = case.places.iter().map(|place| place.position);
    let found: Vec<Integrals> = places.map(|r_i| (prepared.0)(r_i)).collect();
    let [density, force] = errors(&found, exact);
    let along = |tangent: Vector| {
        let forces = found.iter().map(|f| f.gradient.dot(&tangent));
        Error::of(forces, largest(exact)[1])
    };
    MethodReport {
        name: method.name(),
        region: method.region(),
        density,
        force,
        roughness: case.tangent.map(along),
        ns,
        preparation_ms,
        bytes: prepared.1,
        curve: curve(&found),
    }
}

/// Milliseconds before the first frame: the median of some turns.
fn preparation_ms(method: Method, case: &Case, turns: usize) -> f64 {
    let turn = |_| {
        let start = Instant::now();
        black_box(method.prepare(case).1);
        1e3 * start.elapsed().as_secs_f64()
    };
    Range::of(&(0..turns).map(turn).collect::<Vec<_>>()).median
}

/// Nanoseconds per place of some passes along the path.
fn ns_per_place(case: &Case, passes: usize, mut visit: impl FnMut(Vector)) -> f64 {
    let start = Instant::now();
    for _ in 0..passes {
        let places = case.places.iter();
        places.for_each(|place| visit(black_box(place.position)));
    }
    1e9 * start.elapsed().as_secs_f64() / (passes * case.places.len()) as f64
}

/// The errors of density and force.
fn errors(found: &[Integrals], exact: &[Integrals]) -> [Error; 2] {
    let [density, force] = largest(exact);
    let differences = || found.iter().zip(exact).map(|(f, e)| *f - *e);
    [
        Error::of(differences().map(|d| d.kernel), density),
        Error::of(differences().map(|d| d.gradient.norm()), force),
    ]
}

fn largest(exact: &[Integrals]) -> [f64; 2] {
    let values = curve(exact);
    [0, 1].map(|n| values.iter().map(|value| value[n]).fold(0.0, f64::max))
}

/// ∫ W and |∫ ∇W| place by place.
fn curve(integrals: &[Integrals]) -> Vec<[f64; 2]> {
    let values = integrals.iter();
    values.map(|i| [i.kernel, i.gradient.norm()]).collect()
}
