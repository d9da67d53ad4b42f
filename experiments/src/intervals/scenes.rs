//! The scenes on which intervals are tested.

/// A scene with the results that are estimated.
pub(super) struct Scene {
    /// The file, relative to the shipped scenarios.
    pub file: &'static str,
    pub profiles: &'static [&'static str],
    pub results: &'static [&'static str],
}

impl Scene {
    /// The name of its file.
    pub fn name(&self) -> &'static str {
        let name = self.file.trim_start_matches("intervals/");
        name.trim_end_matches(".json")
    }
}

/// The scenes on which the method was made.
pub(super) const MADE_ON: [Scene; 7] = [
    Scene {
        file: "intervals/counterflow.json",
        profiles: &["steer+sph", "walk+sph", "sph", "sf"],
        results: &[
            "all_speed_m_per_s",
            "exposure_above_4_person_secs",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/narrow_door.json",
        profiles: &["steer+sph", "walk+sph", "sf"],
        results: &[
            "evacuated",
            "flow_first_30s_per_s",
            "door_density_per_m2",
            "density_mean_8s",
        ],
    },
    Scene {
        file: "intervals/wide_gap.json",
        profiles: &["steer+sph", "walk+sph", "sph"],
        results: &[
            "gap_flow_per_s",
            "gap_density_per_m2",
            "gap_speed_m_per_s",
            "density_mean_3s",
            "exposure_above_5_person_secs",
        ],
    },
    Scene {
        file: "intervals/junction.json",
        profiles: &["steer+sph", "walk+sph", "sf"],
        results: &[
            "stem_flow_per_s",
            "stem_speed_m_per_s",
            "density_mean_15s",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/tills.json",
        profiles: &["steer+sph"],
        results: &["t95_secs", "waited_secs", "longest_delay_secs"],
    },
    Scene {
        file: "intervals/arrivals.json",
        profiles: &["steer+sph", "sph"],
        results: &[
            "hall_speed_m_per_s",
            "hall_density_per_m2",
            "delay_secs",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/two_exits.json",
        profiles: &["steer+sph", "walk+sph", "sf"],
        results: &[
            "t95_secs",
            "flow_per_s",
            "delay_secs",
            "density_mean_6s",
            "exposure_above_4_person_secs",
            "exposure_above_5_person_secs",
        ],
    },
];

/// The scenes that were written after the method was fixed, except for its fewest runs and the expected means of
/// further runs: these were changed with the counts of all scenes at hand.
pub(super) const WRITTEN_AFTER: [Scene; 6] = [
    Scene {
        file: "intervals/endless.json",
        profiles: &["steer+sph", "sph"],
        results: &[
            "all_speed_m_per_s",
            "density_mean_5s",
            "all_flow_per_m_per_s",
        ],
    },
    Scene {
        file: "intervals/bend.json",
        profiles: &["steer+sph", "walk+sph", "sph"],
        results: &[
            "after_flow_per_s",
            "after_speed_m_per_s",
            "density_mean_8s",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/counters.json",
        profiles: &["steer+sph", "sph"],
        results: &["t95_secs", "waited_secs", "longest_delay_secs"],
    },
    Scene {
        file: "intervals/plaza_of_twenty.json",
        profiles: &["steer+sph", "walk+sph", "sf"],
        results: &[
            "mean_secs",
            "t95_secs",
            "delay_secs",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/gate.json",
        profiles: &["steer+sph", "walk+sph", "sph"],
        results: &[
            "gate_flow_per_s",
            "gate_density_per_m2",
            "evacuated",
            "density_mean_30s",
            "exposure_slow_person_secs",
        ],
    },
    Scene {
        file: "intervals/two_rooms.json",
        profiles: &["steer+sph", "sf", "sf->sph"],
        results: &[
            "t95_secs",
            "flow_first_20s_per_s",
            "room_flow_per_s",
            "density_mean_15s",
            "exposure_above_4_person_secs",
        ],
    },
];
