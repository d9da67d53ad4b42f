//! Errors and costs of every method on every path.

use serde::Serialize;

use super::timing::{self, Effort};
use super::{Case, Integrals, METHODS, Method, Prepared, Region, SUPPORT_RADIUS, cases};
use crate::analysis::statistics::Range;
use crate::engine::math::Vector;

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
    /// Of ∫ W.
    pub density: Error,
    /// Of ∫ ∇W, as a vector.
    pub force: Error,
    /// Of the force along an endless straight wall, which should be 0: the roughness of the wall.
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
    /// Meters, place by place.
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
    let (places, effort) = if quick {
        (
            10,
            Effort {
                turns: 3,
                passes: 2,
            },
        )
    } else {
        (
            50,
            Effort {
                turns: 7,
                passes: 40,
            },
        )
    };
    let cases = cases(places);
    WallReport {
        quick,
        cases: cases.iter().map(|case| of_case(case, effort)).collect(),
    }
}

/// The exact integrals over both regions at every place.
struct Truth {
    hidden: Vec<Integrals>,
    solid: Vec<Integrals>,
}

impl Truth {
    fn to(tolerance: f64, case: &Case) -> Self {
        let over = |region| {
            let places = case.places.iter().map(|place| place.position);
            places
                .map(|r_i| Integrals::over(region, &case.walls, r_i, SUPPORT_RADIUS, tolerance))
                .collect()
        };
        Self {
            hidden: over(Region::Hidden),
            solid: over(Region::Solid),
        }
    }

    fn of(&self, region: Region) -> &[Integrals] {
        match region {
            Region::Hidden => &self.hidden,
            Region::Solid => &self.solid,
        }
    }

    fn difference(&self, other: &Self) -> f64 {
        let own = self.hidden.iter().chain(&self.solid);
        let others = other.hidden.iter().chain(&other.solid);
        own.zip(others)
            .map(|(a, b)| a.distance(b))
            .fold(0.0, f64::max)
    }
}

fn of_case(case: &Case, effort: Effort) -> CaseReport {
    let truth = Truth::to(TOLERANCE, case);
    let [solid_density, solid_force] = errors(&truth.solid, &truth.hidden);
    let prepared = METHODS.map(|method| timing::prepared(method, case, effort));
    let (mut prepared, preparation_ms): (Vec<Prepared>, Vec<f64>) = prepared.into_iter().unzip();
    let times = timing::evaluations(&mut prepared, case, effort);
    let methods = METHODS
        .iter()
        .zip(&mut prepared)
        .zip(preparation_ms)
        .zip(times);
    CaseReport {
        name: case.name,
        axis: case.axis,
        along: case.places.iter().map(|place| place.along).collect(),
        hidden: curve(&truth.hidden),
        solid: curve(&truth.solid),
        solid_density,
        solid_force,
        quadrature: truth.difference(&Truth::to(COARSER_TOLERANCE, case)),
        search_ns: Range::of(&timing::searches(case, effort)),
        methods: methods
            .map(|(((method, prepared), preparation_ms), ns)| MethodReport {
                preparation_ms,
                ns: Range::of(&ns),
                ..of_method(method, prepared, case, &truth)
            })
            .collect(),
    }
}

/// All results but the times.
fn of_method(method: &Method, prepared: &mut Prepared, case: &Case, truth: &Truth) -> MethodReport {
    let exact = truth.of(method.region());
    let places = case.places.iter().map(|place| place.position);
    let found: Vec<Integrals> = places.map(|r_i| prepared.integrals(r_i)).collect();
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
        ns: Range::of(&[]),
        preparation_ms: 0.0,
        bytes: prepared.bytes(),
        curve: curve(&found),
    }
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

fn curve(integrals: &[Integrals]) -> Vec<[f64; 2]> {
    integrals
        .iter()
        .map(|i| [i.kernel, i.gradient.norm()])
        .collect()
}
