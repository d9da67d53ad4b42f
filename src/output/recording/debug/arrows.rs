//! The arrows of forces: their lengths, colors and names.

use rerun::{Arrows2D, Points2D, Radius};

use super::Open;
use crate::recording::draw::{color as rgb, xy};
use engine::math::{Vector, direction};
use engine::profile::Term;
use engine::scene::Scene;
use figures::colors::{self, Rgb};

/// The growth of an arrow's length per factor of ten of a large acceleration, meters.
const PER_DECADE: f64 = 0.6;
/// Accelerations far below this one have arrows too short to see, m/s².
const SMALL: f64 = 0.1;
/// The color of the sum of all forces.
pub const TOTAL: Rgb = [255; 3];
/// Half the widths of the arrows of the sum and of forces, pixels: where both are one, both can be seen.
const BROAD: f32 = 3.5;
const THIN: f32 = 1.6;
/// The color of forces on all agents.
const OWN: Rgb = [170; 3];
/// The distance from the tip of an arrow to the middle of its name along x and y, meters.
const GAP: [f64; 2] = [0.5, 0.22];
/// The names of short arrows are as far from the agent as if the arrows had this length, meters.
const SHORT: f64 = 0.3;
/// The size of a name, meters: two names closer than this in x and y would cover each other.
const NAME: [f64; 2] = [1.2, 0.24];

/// The length of the arrow of an acceleration in m/s²: 0.6 m × log₁₀(1 + a / 0.1 m/s²), in meters. 0.2 m/s² and
/// 20 m/s² can both be seen.
pub fn arrow_length(acceleration: f64) -> f64 {
    PER_DECADE * (1.0 + acceleration / SMALL).log10()
}

/// The arrow of an acceleration, meters.
pub fn arrow(acceleration: Vector) -> Vector {
    direction(acceleration) * arrow_length(acceleration.norm())
}

/// The law of lengths, in words.
pub fn law() -> String {
    let of = |a: f64| format!("{:.2} m for {a}", arrow_length(a));
    let examples = [0.2, 2.0, 20.0].map(of).join(", ");
    format!("{PER_DECADE} m × log₁₀(1 + a / {SMALL} m/s²): {examples} m/s²")
}

/// A term that acts in a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Acting {
    /// Its name in breakdowns.
    pub name: String,
    /// The color of its arrows, in words and as RGB.
    pub color: (&'static str, Rgb),
}

impl Acting {
    fn new(name: &str, number: usize) -> Self {
        Self {
            name: name.to_owned(),
            color: colors::TERMS[number % colors::TERMS.len()],
        }
    }

    /// Its name with spaces.
    pub fn in_words(&self) -> String {
        self.name.replace('_', " ")
    }
}

/// The terms that some profile of `scene` has: those of the paper, then those of other forces.
pub fn acting(scene: &Scene) -> Vec<Acting> {
    let acts = |term: &&Term| {
        let mut profiles = scene.profiles();
        (!term.is_of_walls() || !scene.walls.is_empty())
            && profiles.any(|profile| profile.has(**term))
    };
    let of_paper = Term::ALL.iter().filter(acts);
    let mut all: Vec<Acting> = of_paper
        .map(|term| Acting::new(term.name(), *term as usize))
        .collect();
    let mut number = Term::ALL.len();
    for force in scene.profiles().flat_map(|profile| &profile.forces) {
        for name in force.term_names() {
            if all.iter().all(|acting| acting.name != name) {
                all.push(Acting::new(name, number));
                number += 1;
            }
        }
    }
    all
}

/// A force on an agent: its name, its acceleration in m/s², and the color of its arrow.
pub type Force = (String, Vector, Rgb);

/// The sum of the forces on an agent, and the forces that are not zero.
pub fn forces(agent: &Open, terms: &[Acting]) -> Vec<Force> {
    let of_term = |term: &Acting| (term.in_words(), agent.force(&term.name), term.color.1);
    let forces = agent.breakdown.own_forces.iter();
    let own = forces.map(|force| (force.name.clone(), force.acceleration.into(), OWN));
    let total = (
        "total".to_owned(),
        agent.breakdown.acceleration.into(),
        TOTAL,
    );
    let all = std::iter::once(total)
        .chain(terms.iter().map(of_term))
        .chain(own);
    all.filter(|(_, acceleration, _)| *acceleration != Vector::zeros())
        .collect()
}

/// The arrows of these forces at the origin, the first one broad, and their names beside the tips. Arrows too short to
/// see have no names.
pub fn named(forces: &[Force]) -> (Arrows2D, Points2D) {
    let vectors: Vec<Vector> = forces.iter().map(|force| arrow(force.1)).collect();
    let arrows = Arrows2D::update_fields()
        .with_origins(vectors.iter().map(|_| [0.0, 0.0]))
        .with_vectors(vectors.iter().map(|&vector| xy(vector)))
        .with_radii(
            (0..vectors.len()).map(|k| Radius::new_ui_points(if k == 0 { BROAD } else { THIN })),
        )
        .with_colors(forces.iter().map(|force| rgb(force.2)));
    let long = || {
        let both = forces.iter().zip(&vectors);
        both.filter(|(_, vector)| vector.norm() > 0.05)
    };
    let beside = |vector: &Vector| {
        let way = direction(*vector);
        way * vector.norm().max(SHORT) + way.component_mul(&Vector::from(GAP))
    };
    let places: Vec<Vector> = long().map(|(_, vector)| beside(vector)).collect();
    let names = Points2D::update_fields()
        .with_positions(apart(&places).into_iter().map(xy))
        .with_labels(long().map(|(force, _)| force.0.as_str()))
        .with_colors(long().map(|(force, _)| rgb(force.2)));
    (arrows, names)
}

/// The places of names, moved up or down until no two cover each other.
fn apart(places: &[Vector]) -> Vec<Vector> {
    let mut order: Vec<usize> = (0..places.len()).collect();
    order.sort_by(|&a, &b| places[a].y.total_cmp(&places[b].y));
    let mut moved = places.to_vec();
    for (k, &this) in order.iter().enumerate() {
        for &lower in &order[..k] {
            let [across, up] = [0, 1].map(|axis| moved[this][axis] - moved[lower][axis]);
            if across.abs() < NAME[0] && up < NAME[1] {
                moved[this].y = moved[lower].y + NAME[1];
            }
        }
    }
    moved
}
