//! The model of the paper, whole and plain: scalar arithmetic on all pairs, in the paper's order and symbols.
//!
//! van Toll, Chatagnon, Braga, Solenthaler, Pettré: "SPH crowds: Agent-based crowd simulation up to extreme densities
//! using fluid dynamics", Computers & Graphics 2021, <https://doi.org/10.1016/j.cag.2021.06.005>. Sections, equations
//! and symbols are the paper's; units are meters, seconds and persons. A *reading* is a choice that the paper leaves
//! open (docs/reference/model.md). The engine computes the same, but faster: tests/paper.rs compares it with this file.
//!
//! ```sh
//! cargo run --release --example paper -- evacuation          # §6.1 with the profile sph
//! cargo run --release --example paper -- evacuation sf 250   # a row of Table 1: the profile, then K^ag or ρ⁰max
//! cargo run --release --example paper -- STATE.json          # every term of every agent
//! ```
//!
//! The folder `paper/` has the rest: bodies (§5.6), the state of a crowd, vectors and walls, the evacuation, and files.

#[path = "paper/crowd.rs"]
mod crowd;
#[path = "paper/evacuation.rs"]
pub mod evacuation;
#[path = "paper/plane.rs"]
mod plane;
#[path = "paper/states.rs"]
pub mod states;

use std::f64::consts::{PI, TAU};

pub use crowd::{Agent, Behavior, Crowd, HiddenRegion, Navigation, Profile};
pub use plane::{Vector, Wall};
use rand::RngCore;

// §3.3 Computing density, pressure, and forces. Eqs. 1 and 3 are the general forms of Eq. 2 and of Eqs. 4, 6 and 7.
const GAS_CONSTANT: f64 = 200.0; // k (§5.5)

/// Eq. 5: p_i = k (ρ_i − ρ_i⁰).
fn pressure(density: f64, rest_density: f64) -> f64 {
    GAS_CONSTANT * (density - rest_density)
}

/// Eq. 7, the term of agent j: m_j (v_j − v_i)/ρ_j ∇²W(r_i − r_j).
pub fn viscosity_by_agent(i: &Agent, j: &Agent) -> Vector {
    (j.velocity - i.velocity) * (j.mass / j.density * laplacian(i.position - j.position))
}

// §4.1 Combined simulation loop

/// Steps 1B to 4: all a_i. Step 1, the search for neighbors, is left out: here all agents look at all others.
pub fn evaluate(crowd: &mut Crowd) -> Vec<Vector> {
    for n in 0..crowd.agents.len() {
        update_density_and_pressure(crowd, n); // 1B
    }
    for n in 0..crowd.agents.len() {
        crowd.agents[n].avoidance = held_avoidance(crowd, &crowd.agents[n]); // 3: RVO
    }
    let agents = crowd.agents.iter();
    agents.map(|i| acceleration(crowd, i)).collect() // 2, 3, 3B, 4
}

/// Steps 3, 3B and 4 for one profile: the terms of a_i. Reading: the forces of Eq. 16 are divided by m_i, as contact.
pub fn terms(crowd: &Crowd, i: &Agent, profile: &Profile) -> Vec<(&'static str, Vector)> {
    let agents = |force: &dyn Fn(&Agent) -> Vector| -> Vector {
        let others = crowd.agents.iter().filter(|j| j.id != i.id);
        others.map(force).sum()
    };
    let mut terms = Vec::new();
    if profile.navigation == Navigation::Rvo {
        terms.push(("rvo", i.avoidance.unwrap_or_default()));
    } else {
        terms.push(("goal", goal_force(i) / i.mass));
    }
    if profile.navigation == Navigation::Social {
        let by_agents = agents(&|j| social_force_by_agent(i, j));
        let points = repelling_points(crowd, i).into_iter();
        let by_walls: Vector = points.map(|r_k| social_force_by_wall(i, r_k)).sum();
        terms.push(("social_agents", by_agents / i.mass));
        terms.push(("social_walls", by_walls / i.mass));
    }
    if profile.sph {
        // Eq. 2; below ρ_i⁰ there is no pressure force (§5.2). Reading: negative p_j stay in the sum of Eq. 11.
        let felt = if i.density < i.rest_density { 0.0 } else { 1.0 };
        let by_agents = agents(&|j| pressure_by_agent(i, j)) * felt;
        let regions = hidden_regions(crowd, i);
        let by_walls = regions.map(|p_k| pressure_by_wall(i, &p_k)).sum::<Vector>() * felt;
        let viscosity = agents(&|j| viscosity_by_agent(i, j)) * crowd.behavior.viscosity;
        terms.push(("pressure_agents", by_agents / i.density));
        terms.push(("pressure_walls", by_walls / i.density));
        terms.push(("viscosity", viscosity / i.density));
    }
    let by_agents = agents(&|j| contact_by_agent(i, j, profile));
    let walls = crowd.walls.iter();
    let by_walls: Vector = walls.map(|o_k| contact_by_wall(i, o_k, profile)).sum();
    terms.push(("contact_agents", by_agents / i.mass));
    terms.push(("contact_walls", by_walls / i.mass));
    terms
}

/// Step 5. Readings: the new velocity moves an agent (semi-implicit Euler), clamped after all forces; walls stop moves.
pub fn integrate(crowd: &mut Crowd, accelerations: &[Vector]) {
    for (i, &a_i) in crowd.agents.iter_mut().zip(accelerations) {
        i.velocity = (i.velocity + a_i * TIME_STEP).clamped(MAX_SPEED);
        (i.position, i.velocity) = plane::moved(i.position, i.velocity, TIME_STEP, &crowd.walls);
    }
    crowd.frame += 1;
}

// §4.2 Dynamic personal rest density
const AVERAGING_TIME: f64 = 0.1; // T^ρ (§5.5)
const REST_DENSITY_MIN: f64 = 0.0; // ρ⁰min (§5.5)

/// Eq. 8: ρ̂_i := (1 − Δt/T^ρ) ρ̂_i + Δt/T^ρ ρ_i.
fn mean_density(before: f64, density: f64) -> f64 {
    let alpha = TIME_STEP / AVERAGING_TIME;
    (1.0 - alpha) * before + alpha * density
}

/// Step 1B. Reading: walls have ρ_i⁰ of the previous frame; in an agent's first frame ρ̂_i is the density from agents.
fn update_density_and_pressure(crowd: &mut Crowd, n: usize) {
    let i = &crowd.agents[n];
    let clamped = |mean: f64| mean.clamp(REST_DENSITY_MIN, crowd.behavior.rest_density_max);
    let by_agents: f64 = crowd.agents.iter().map(|j| density_by_agent(i, j)).sum();
    let before = i.mean_density.unwrap_or(by_agents);
    let by_wall = |p_k| density_by_wall(i, clamped(before), &p_k);
    let by_walls: f64 = hidden_regions(crowd, i).map(by_wall).sum();
    let mean = mean_density(before, by_agents + by_walls);
    let rest_density = clamped(mean);
    let i = &mut crowd.agents[n];
    (i.density, i.density_by_walls) = (by_agents + by_walls, by_walls);
    (i.mean_density, i.rest_density) = (Some(mean), rest_density);
    i.pressure = pressure(i.density, i.rest_density);
}

// §4.3 SPH obstacle handling

/// The part of the disc of radius h around r_i that wall O_k hides (Fig. 2). Reading: nothing from agents behind it.
fn hidden_region(o_k: &Wall, r_i: Vector) -> Option<HiddenRegion> {
    let d = o_k.distance(r_i);
    if !(0.0..H).contains(&d) {
        return None;
    }
    // Along the wall from the foot of the perpendicular: its ends in the disc, and their angles.
    let (d, half_chord) = (d.max(plane::ROUNDING), (H * H - d * d).sqrt());
    let ends = [o_k.start, o_k.end].map(|end| (end - r_i).dot(o_k.tangent()));
    let [s_1, s_2] = ends.map(|s| s.clamp(-half_chord, half_chord));
    let [t_1, t_2] = [s_1, s_2].map(|s| s.atan2(d));
    let to_nearest = o_k.tangent() * 0.0_f64.clamp(s_1, s_2) - o_k.normal() * d;
    let halfway = 0.5 * (to_nearest.norm() + H);
    (s_1 < s_2).then(|| HiddenRegion {
        nearest_point: r_i + to_nearest,
        representative_point: r_i + to_nearest.direction() * halfway,
        area: 0.5 * (H * H * (t_2 - t_1) - d * (s_2 - s_1)),
    })
}

/// All P_k. Reading: areas that several walls hide count several times.
pub fn hidden_regions(crowd: &Crowd, i: &Agent) -> impl Iterator<Item = HiddenRegion> {
    let walls = crowd.walls.iter();
    walls.filter_map(|o_k| hidden_region(o_k, i.position))
}

/// Eq. 4, the first sum of Eq. 9, the term of agent j: m_j W(r_i − r_j). Reading: the sum includes j = i.
fn density_by_agent(i: &Agent, j: &Agent) -> f64 {
    j.mass * kernel(i.position - j.position)
}

/// Eq. 10: ρ_k^wall = ρ_i⁰ a(P_k) W(r_i − r_k^o).
fn density_by_wall(i: &Agent, rest_density: f64, p_k: &HiddenRegion) -> f64 {
    rest_density * p_k.area * kernel(i.position - p_k.representative_point)
}

/// Eqs. 6 and 11, the term of agent j: −m_j (p_i + p_j)/(2ρ_j) ∇W(r_i − r_j).
pub fn pressure_by_agent(i: &Agent, j: &Agent) -> Vector {
    let p = i.pressure + j.pressure;
    -gradient(i.position - j.position) * (j.mass * p / (2.0 * j.density))
}

/// Eq. 12: f_k^wall = −p_i a(P_k) ∇W(r_i − r_k^o).
fn pressure_by_wall(i: &Agent, p_k: &HiddenRegion) -> Vector {
    -gradient(i.position - p_k.representative_point) * (i.pressure * p_k.area)
}

// §4.4 Density-dependent behavior blending

/// The profiles that act at density ρ_i, with their weights. Reading: all profiles share ρ̂_i, ρ_i⁰ and p_i.
pub fn acting(behavior: &Behavior, density: f64) -> Vec<(&Profile, f64)> {
    let all = &behavior.profiles;
    match all.iter().position(|(_, rho_j)| density <= *rho_j) {
        Some(0) => vec![(&all[0].0, 1.0)],
        None => vec![(&all[all.len() - 1].0, 1.0)],
        Some(next) => {
            let [(low, rho_low), (high, rho_high)] = [&all[next - 1], &all[next]];
            let kappa = (density - rho_low) / (rho_high - rho_low);
            vec![(low, 1.0 - kappa), (high, kappa)]
        }
    }
}

/// a_i: the weighted sum of the accelerations by the profiles that act.
pub fn acceleration(crowd: &Crowd, i: &Agent) -> Vector {
    let acting = acting(&crowd.behavior, i.density).into_iter();
    let weighted = acting.map(|(profile, weight)| {
        let felt = terms(crowd, i, profile).into_iter();
        felt.map(|(_, term)| term).sum::<Vector>() * weight
    });
    weighted.sum()
}

// §5.1 Multiple framerates
const TIME_STEP: f64 = 0.02; // Δt_fine (§5.6)
const COARSE_EVERY: u64 = 5; // Δt_coarse/Δt_fine (§5.6)

/// RVO's a_i, chosen in coarse frames and held in between. Reading: also chosen when RVO begins to act in between.
fn held_avoidance(crowd: &Crowd, i: &Agent) -> Option<Vector> {
    let is_rvo = |(profile, _): (&Profile, f64)| profile.navigation == Navigation::Rvo;
    let rvo_acts = acting(&crowd.behavior, i.density).into_iter().any(is_rvo);
    let is_coarse = crowd.frame.is_multiple_of(COARSE_EVERY);
    let held = i.avoidance.filter(|_| !is_coarse);
    rvo_acts.then(|| held.unwrap_or_else(|| rvo_acceleration(crowd, i)))
}

// §5.2 SPH details
const H: f64 = 1.0; // h

/// Eq. 13: W.
fn kernel(r: Vector) -> f64 {
    4.0 / (PI * H.powi(8)) * (H * H - r.dot(r)).max(0.0).powi(3)
}

/// Eq. 14: ∇W; zero at r = 0.
fn gradient(r: Vector) -> Vector {
    r.direction() * (-30.0 / (PI * H.powi(5)) * (H - r.norm()).max(0.0).powi(2))
}

/// Eq. 15: ∇²W.
fn laplacian(r: Vector) -> f64 {
    360.0 / (29.0 * PI * H.powi(5)) * (H - r.norm()).max(0.0)
}

// §5.3 Collision avoidance
pub const AVOIDANCE_RADIUS: f64 = 5.0;
const PREFERRED_SPEED: f64 = 1.4; // s_pref (§5.6)
const MAX_SPEED: f64 = 1.8; // s_max (§5.6)

/// v_i^pref (§5): straight to the goal.
fn preferred_velocity(i: &Agent) -> Vector {
    (i.goal - i.position).direction() * PREFERRED_SPEED
}

// §5.3.1 Social force model. Reading: the forces of Eq. 16 are divided by m_i.
const GOAL_SCALE: f64 = 1.0; // K^goal (§5.5)
const RELAXATION_TIME: f64 = 0.5; // τ (§5.5)
const AGENT_STRENGTH: f64 = 2.1; // V₀ (§5.5)
const AGENT_RANGE: f64 = 0.3; // σ (§5.5)
const ANTICIPATION_TIME: f64 = 2.0; // T (§5.5)
const WALL_STRENGTH: f64 = 2.1; // U₀ (§5.5)
const WALL_RANGE: f64 = 0.1; // R (§5.5)

/// Eq. 17: K^goal (v_i^pref − v_i)/τ.
fn goal_force(i: &Agent) -> Vector {
    (preferred_velocity(i) - i.velocity) * (GOAL_SCALE / RELAXATION_TIME)
}

/// Eq. 18: −∇ V₀ e^(−b/σ) with respect to r_ij. Reading: v_ij is held fixed.
pub fn social_force_by_agent(i: &Agent, j: &Agent) -> Vector {
    let (r_ij, v_ij) = (i.position - j.position, i.velocity - j.velocity);
    let way = v_ij * ANTICIPATION_TIME;
    let sum = r_ij.norm() + (r_ij + way).norm();
    let b = 0.5 * (sum * sum - way.dot(way)).max(0.0).sqrt();
    if b == 0.0 || r_ij.norm() >= AVOIDANCE_RADIUS {
        return Vector::ZERO;
    }
    let gradient_of_b = (r_ij.direction() + (r_ij + way).direction()) * (sum / (4.0 * b));
    let slope = AGENT_STRENGTH / AGENT_RANGE * (-b / AGENT_RANGE).exp();
    gradient_of_b * (slope * weight_in_view(i, -r_ij))
}

/// Eq. 19: −∇ U₀ e^(−|r_ik|/R).
fn social_force_by_wall(i: &Agent, r_k: Vector) -> Vector {
    let r_ik = i.position - r_k;
    let slope = WALL_STRENGTH / WALL_RANGE * (-r_ik.norm() / WALL_RANGE).exp();
    r_ik.direction() * (slope * weight_in_view(i, -r_ik))
}

/// The field of view. Reading: measured toward the neighbor, not along r_ij; an agent at rest sees all around.
fn weight_in_view(i: &Agent, toward: Vector) -> f64 {
    let cosine = i.velocity.direction().dot(toward.direction());
    let is_seen = i.velocity == Vector::ZERO || cosine >= 100_f64.to_radians().cos();
    if is_seen { 1.0 } else { 0.5 }
}

/// The r_k* of Eq. 19. Reading: of walls on whose free side the agent is; a corner of two walls counts once.
fn repelling_points(crowd: &Crowd, i: &Agent) -> Vec<Vector> {
    let mut points: Vec<Vector> = Vec::new();
    for o_k in crowd.walls.iter().filter(|o_k| o_k.faces(i.position)) {
        let r_k = o_k.nearest_point(i.position);
        if (i.position - r_k).norm() < AVOIDANCE_RADIUS && !points.contains(&r_k) {
            points.push(r_k);
        }
    }
    points
}

// §5.3.2 RVO
const COLLISION_WEIGHT: f64 = 1.0; // w (§5.5)
const CANDIDATES: usize = 250; // reading

/// TTC(i, u): infinite without a collision. Readings: what agent i touches already (itself, too) and walls from behind
/// are ignored.
fn time_to_collision(crowd: &Crowd, i: &Agent, u: Vector) -> f64 {
    let agents = crowd.agents.iter().filter_map(|j| {
        let (r_ij, reach) = (i.position - j.position, i.radius + j.radius);
        let is_met = reach < r_ij.norm() && r_ij.norm() < AVOIDANCE_RADIUS;
        is_met.then(|| plane::time_to_contact(-r_ij, u - j.velocity, reach))
    });
    let walls = crowd.walls.iter().filter_map(|o_k| {
        let r_ik = i.position - o_k.nearest_point(i.position);
        let is_met = i.radius < r_ik.norm() && r_ik.norm() < AVOIDANCE_RADIUS;
        let is_met = is_met && o_k.faces(i.position);
        is_met.then(|| o_k.time_to_contact(i.position, u, i.radius))
    });
    agents.chain(walls).fold(f64::INFINITY, f64::min)
}

/// Eq. 20: C(v′) = |v′ − v_i^pref| + w/TTC(i, 2v′ − v_i).
fn cost(crowd: &Crowd, i: &Agent, candidate: Vector) -> f64 {
    let time = time_to_collision(crowd, i, candidate * 2.0 - i.velocity);
    (candidate - preferred_velocity(i)).norm() + COLLISION_WEIGHT / time
}

/// Reading: candidates lie around v_i, at uniform angles and at uniform distances of up to 2 s_max.
fn candidates(crowd: &Crowd, i: &Agent) -> impl Iterator<Item = Vector> {
    let mut random = crowd::candidate_numbers(crowd.seed, i.id, crowd.frame / COARSE_EVERY);
    (0..CANDIDATES).map(move |_| {
        let angle = f64::from(random.next_u32()) * TAU / 2_f64.powi(32);
        let length = f64::from(random.next_u32()) * 2.0 * MAX_SPEED / f64::from(u32::MAX);
        i.velocity + Vector::at(angle) * length
    })
}

/// Eq. 21: (v* − v_i)/Δt_coarse. Readings: v* is the first of the cheapest below s_max, zero if all are too fast.
fn rvo_acceleration(crowd: &Crowd, i: &Agent) -> Vector {
    let slow = candidates(crowd, i).filter(|candidate| candidate.norm() <= MAX_SPEED);
    let costs = slow.map(|candidate| (cost(crowd, i, candidate), candidate));
    let cheapest = costs.min_by(|(a, _), (b, _)| a.total_cmp(b));
    let v_star = cheapest.map_or(Vector::ZERO, |(_, candidate)| candidate);
    (v_star - i.velocity) / (COARSE_EVERY as f64 * TIME_STEP)
}

// §5.4 Contact forces

/// Eq. 22: K^ag max(0, D_i + D_j − |r_ij|) r_ij/|r_ij|; zero at r_ij = 0.
pub fn contact_by_agent(i: &Agent, j: &Agent, profile: &Profile) -> Vector {
    let r_ij = i.position - j.position;
    let overlap = (i.radius + j.radius - r_ij.norm()).max(0.0);
    r_ij.direction() * (profile.agent_stiffness * overlap)
}

/// Eq. 23: K^obs max(0, D_i − |r_ik|) r_ik/|r_ik|. Reading: of all walls, from both sides; at a corner of both walls.
fn contact_by_wall(i: &Agent, o_k: &Wall, profile: &Profile) -> Vector {
    let overlap = (i.radius - (i.position - o_k.nearest_point(i.position)).norm()).max(0.0);
    o_k.away(i.position) * (profile.wall_stiffness * overlap)
}

// §5.5 Navigation profiles and parameter settings

/// `sf`, `rvo`, `sf+sph`, `rvo+sph` or `sph`, with its K^ag and K^obs.
fn profile(name: &str) -> Result<Profile, String> {
    let (navigation, sph) = match name {
        "sf" => (Navigation::Social, false),
        "rvo" => (Navigation::Rvo, false),
        "sf+sph" => (Navigation::Social, true),
        "rvo+sph" => (Navigation::Rvo, true),
        "sph" => (Navigation::Goal, true),
        _ => return Err(format!("unknown profile `{name}`")),
    };
    let (agent_stiffness, wall_stiffness) = if sph { (50.0, 200.0) } else { (1000.0, 1000.0) };
    Ok(Profile {
        name: name.to_owned(),
        navigation,
        sph,
        agent_stiffness,
        wall_stiffness,
    })
}

/// A profile, or the blend `sf->sph` or `rvo->sph` with ρ^j of 2 and 4, also written `sf-sph` and `rvo-sph`.
pub fn behavior(name: &str) -> Result<Behavior, String> {
    let profiles = match name.split_once("->").or(name.split_once('-')) {
        Some((low, high)) => vec![(profile(low)?, 2.0), (profile(high)?, 4.0)],
        None => vec![(profile(name)?, 0.0)],
    };
    Ok(Behavior {
        profiles,
        rest_density_max: 5.0, // ρ⁰max
        viscosity: 0.0,        // μ
    })
}

pub fn main() -> Result<(), Box<dyn std::error::Error>> {
    println!("{:#}", states::answer(std::env::args().skip(1))?);
    Ok(())
}
