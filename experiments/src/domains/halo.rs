//! The agents of other parts that a part reads.

use rayon::prelude::*;
use sandbox::engine::math::Vector;
use sandbox::engine::neighbors::Grid;

/// A crowd in the cells of the engine's grid.
pub struct Field {
    /// The positions in the order of the cells, meters.
    positions: Vec<Vector>,
    /// Each agent's place in the order of the cells is its index here.
    order: Vec<u32>,
    grid: Grid,
    reach: f64,
}

/// The halos of all parts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Halos {
    /// Agents of other parts in reach of an agent of this part, part by part.
    pub agents: Vec<u32>,
    /// Parts with such agents, part by part.
    pub neighbors: Vec<u32>,
}

impl Field {
    /// Agents closer than `reach` meters read each other.
    pub fn new(positions: &[Vector], reach: f64) -> Self {
        let mut grid = Grid::default();
        let mut order = Vec::new();
        grid.rebuild(positions, reach, None, &mut order);
        let sorted = order.iter().map(|&i| positions[i as usize]);
        Self {
            positions: sorted.collect(),
            order,
            grid,
            reach,
        }
    }

    /// The number of other agents closer than `radius` meters, at most the reach, for each agent in the order that the
    /// field was given.
    pub fn neighbors(&self, radius: f64) -> Vec<u32> {
        let sorted = (0..self.positions.len()).into_par_iter();
        let sorted = sorted.map(|i| self.near(i, radius).count() as u32 - 1);
        let mut counts = vec![0; self.positions.len()];
        for (&i, count) in self.order.iter().zip(sorted.collect::<Vec<_>>()) {
            counts[i as usize] = count;
        }
        counts
    }

    /// The agents closer than `radius` meters to agent `i`, and itself.
    fn near(&self, i: usize, radius: f64) -> impl Iterator<Item = usize> + '_ {
        let p = self.positions[i];
        let rows = self.grid.rows(p, [p; 2], radius);
        let near = rows.flat_map(|run| run.indices());
        near.filter(move |&j| (p - self.positions[j]).norm_squared() < radius * radius)
    }

    /// The halos of a crowd whose agents are in these parts, in the order that the field was given.
    pub fn halos(&self, part_of: &[u32], parts: usize) -> Halos {
        let part_of: Vec<u32> = self.order.iter().map(|&i| part_of[i as usize]).collect();
        // Each agent once for each other part that reads it: this part, and the agent's own.
        let reads = (0..self.positions.len()).into_par_iter().fold(
            Vec::new,
            |mut reads: Vec<[u32; 2]>, i| {
                let (own, first) = (part_of[i], reads.len());
                for part in self.near(i, self.reach).map(|j| part_of[j]) {
                    if part != own && !reads[first..].contains(&[part, own]) {
                        reads.push([part, own]);
                    }
                }
                reads
            },
        );
        let mut reads: Vec<[u32; 2]> = reads.flatten_iter().collect();
        let mut halos = Halos {
            agents: vec![0; parts],
            neighbors: vec![0; parts],
        };
        for [reader, _] in &reads {
            halos.agents[*reader as usize] += 1;
        }
        reads.par_sort_unstable();
        reads.dedup();
        for [reader, _] in &reads {
            halos.neighbors[*reader as usize] += 1;
        }
        halos
    }
}

#[cfg(test)]
mod tests {
    use super::super::cut::Way;
    use super::*;
    use rand::{Rng, SeedableRng, rngs::StdRng};

    const REACH: f64 = 1.14;

    fn crowd(count: usize) -> Vec<Vector> {
        let mut random = StdRng::seed_from_u64(11);
        let mut place =
            |_| Vector::new(12.0 * random.random::<f64>(), 9.0 * random.random::<f64>());
        (0..count).map(&mut place).collect()
    }

    fn are_near(p: Vector, q: Vector) -> bool {
        (p - q).norm_squared() < REACH * REACH
    }

    #[test]
    fn halos_are_those_of_all_pairs() {
        let crowd = crowd(400);
        let field = Field::new(&crowd, REACH);
        for way in Way::ALL {
            for parts in [2, 4, 16, 64] {
                let part_of = way.cut(&crowd, &[1.0; 400], parts).parts(&crowd);
                let mut expected = Halos {
                    agents: Vec::new(),
                    neighbors: Vec::new(),
                };
                for part in 0..parts as u32 {
                    let own = |i: &usize| part_of[*i] == part;
                    let others = (0..crowd.len()).filter(|i| !own(i));
                    let read = others.filter(|&j| {
                        let mut own = (0..crowd.len()).filter(own);
                        own.any(|i| are_near(crowd[i], crowd[j]))
                    });
                    let mut from: Vec<u32> = read.map(|j| part_of[j]).collect();
                    expected.agents.push(from.len() as u32);
                    from.sort_unstable();
                    from.dedup();
                    expected.neighbors.push(from.len() as u32);
                }
                let found = field.halos(&part_of, parts);
                assert_eq!(found, expected, "{}, {parts} parts", way.name());
            }
        }
    }

    #[test]
    fn one_part_has_no_halo() {
        let crowd = crowd(200);
        for way in Way::ALL {
            let part_of = way.cut(&crowd, &[1.0; 200], 1).parts(&crowd);
            let halos = Field::new(&crowd, REACH).halos(&part_of, 1);
            assert_eq!((halos.agents, halos.neighbors), (vec![0], vec![0]));
        }
    }

    #[test]
    fn neighbors_are_counted_in_the_given_order() {
        let crowd = crowd(300);
        let counts = Field::new(&crowd, REACH).neighbors(REACH);
        for (i, &count) in counts.iter().enumerate() {
            let all = (0..crowd.len()).filter(|&j| j != i && are_near(crowd[i], crowd[j]));
            assert_eq!(count as usize, all.count());
        }
    }
}
