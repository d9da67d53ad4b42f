//! The bytes that a process would send for each agent that another process reads.

use sandbox::engine::agents::Agents;
use sandbox::engine::pairs::Columns;
use serde::Serialize;

/// Bytes per agent and frame, by exchange.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize)]
pub struct Traffic {
    /// Positions and velocities, before the densities.
    pub motions: usize,
    /// Volumes and pressures, between the densities and the forces.
    pub densities: usize,
    /// Bodies, in frames in which lists are rebuilt.
    pub bodies: usize,
    /// What RVO reads, in double precision, in coarse frames; 0 without RVO.
    pub avoidance: usize,
}

impl Traffic {
    /// The sizes of the columns that sums over pairs read in mixed precision, and of the arrays that RVO reads.
    pub fn of_columns(with_rvo: bool) -> Self {
        let columns = Columns::<f32>::default();
        let bodies = &columns.bodies;
        let agents = Agents::default();
        let avoidance = entry(&agents.position) + entry(&agents.velocity) + entry(&agents.radius);
        Self {
            motions: entry(&bodies.x)
                + entry(&bodies.y)
                + entry(&bodies.velocity_x)
                + entry(&bodies.velocity_y),
            densities: entry(&columns.volume) + entry(&columns.pressure),
            bodies: entry(&bodies.mass)
                + entry(&bodies.contact_radius)
                + entry(&bodies.per_support),
            avoidance: if with_rvo { avoidance } else { 0 },
        }
    }

    /// In a frame whose lists are kept, and in which RVO holds its choices.
    pub fn usual(&self) -> usize {
        self.motions + self.densities
    }

    /// In a coarse frame with new lists.
    pub fn most(&self) -> usize {
        self.usual() + self.bodies + self.avoidance
    }
}

/// Bytes per entry of a column.
fn entry<T>(_: &[T]) -> usize {
    size_of::<T>()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_column_takes_four_bytes_and_a_double_eight() {
        let traffic = Traffic::of_columns(false);
        // x, y, and the velocity; volume and pressure; mass, radius and 1/h.
        assert_eq!((traffic.usual(), traffic.most()), (4 * 6, 4 * 9));
        let with_rvo = Traffic::of_columns(true);
        // Two vectors and a radius.
        assert_eq!(with_rvo.most() - traffic.most(), 8 * 5);
    }
}
