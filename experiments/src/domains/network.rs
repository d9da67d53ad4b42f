//! A model of the time of a frame on several processes. Its networks are assumptions, not measurements.

use serde::Serialize;

use super::traffic::Traffic;

/// What connects the processes: a message of b bytes takes latency + b/bandwidth (Hockney 1994, The communication
/// challenge for MPP).
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Network {
    /// Its name in reports.
    pub name: &'static str,
    /// Seconds until a short message has arrived.
    pub latency: f64,
    /// Bytes per second into each process.
    pub bandwidth: f64,
}

/// Orders of magnitude of three kinds of connections. InfiniBand: the nominal rate of 100 Gbit/s, and twice the 1.06 µs
/// that the vendor's user guide shows for an MPI ping-pong. Ethernet: the nominal rate of 10 Gbit/s; applications
/// measured 20 µs on TCP without a switch (Hurwitz and Feng 2003, Initial end-to-end performance evaluation of
/// 10-gigabit Ethernet). Shared memory: a few cache lines from another socket, at the memory bandwidth of one core.
pub const NETWORKS: [Network; 3] = [
    Network {
        name: "shared memory",
        latency: 0.5e-6,
        bandwidth: 10e9,
    },
    Network {
        name: "InfiniBand",
        latency: 2e-6,
        bandwidth: 12.5e9,
    },
    Network {
        name: "Ethernet",
        latency: 30e-6,
        bandwidth: 1.25e9,
    },
];

/// The part that takes the longest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Load {
    /// The number of parts.
    pub parts: usize,
    /// Its share of the work of a frame.
    pub share: f64,
    /// The agents of other parts that it reads.
    pub halo: f64,
    pub traffic: Traffic,
}

/// A frame by the model.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Modeled {
    pub network: &'static str,
    pub ms_per_frame: f64,
    /// How many times as fast as one thread.
    pub speed_up: f64,
    /// The speed-up per part.
    pub efficiency: f64,
}

impl Network {
    /// A frame that takes one thread `alone` milliseconds: the work of the largest part, two exchanges with its
    /// neighbors, and the decision whether lists are rebuilt, for which a maximum over all parts takes log₂ P messages,
    /// one after another. Nothing overlaps.
    pub fn model(&self, alone: f64, load: &Load) -> Modeled {
        let bytes = load.halo * load.traffic.most() as f64;
        let exchanges = if load.parts > 1 { 2.0 } else { 0.0 };
        let rounds = f64::from(load.parts.next_power_of_two().ilog2());
        let waiting = (exchanges + rounds) * self.latency + bytes / self.bandwidth;
        let ms_per_frame = alone * load.share + 1e3 * waiting;
        let speed_up = alone / ms_per_frame;
        Modeled {
            network: self.name,
            ms_per_frame,
            speed_up,
            efficiency: speed_up / load.parts as f64,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn load(parts: usize, halo: f64) -> Load {
        Load {
            parts,
            share: 1.0 / parts as f64,
            halo,
            traffic: Traffic::default(),
        }
    }

    #[test]
    fn one_part_is_as_fast_as_one_thread() {
        for network in NETWORKS {
            let modeled = network.model(3.5, &load(1, 0.0));
            assert_eq!((modeled.ms_per_frame, modeled.speed_up), (3.5, 1.0));
        }
    }

    #[test]
    fn no_part_is_faster_than_its_messages() {
        for network in NETWORKS {
            let modeled = network.model(1.0, &load(1 << 20, 100.0));
            assert!(modeled.ms_per_frame > 1e3 * 22.0 * network.latency);
            assert!(modeled.efficiency < 1.0);
        }
    }

    #[test]
    fn an_infinitely_fast_network_divides_the_time_by_the_parts() {
        let network = Network {
            name: "ideal",
            latency: 0.0,
            bandwidth: f64::INFINITY,
        };
        let modeled = network.model(8.0, &load(16, 1000.0));
        assert!((modeled.speed_up - 16.0).abs() < 1e-12);
    }
}
