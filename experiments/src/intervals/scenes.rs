//! The scenes on which intervals are tested.

/// A scene with the results that are estimated.
pub(super) struct Scene {
    /// The file, relative to the shipped scenarios.
    pub file: &'static str,
    pub profiles: &'static [&'static str],
    pub results: &'static [&'static str],
}

/// The scenes on which the method was made.
pub(super) const MADE_ON: [Scene; 6] = [
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
];
