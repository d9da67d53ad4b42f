//! The keys of nested objects, for the list of settings.

/// The keys of the nested objects; `?` marks optional keys.
pub const NESTED: [(&str, &str); 9] = [
    (
        "agents",
        "position, velocity?, radius?, mass?, goal?, mean_density?, profile?, remove_within?, counted?",
    ),
    (
        "grids",
        "min, max, columns, rows, name?, jitter?, goal? or goal_offset?, profile?, remove_within?, counted?",
    ),
    (
        "sources",
        "the keys of grids, and every_secs, start_secs?, times?",
    ),
    (
        "events",
        "at_secs, for_secs, region, name?, goal_scale?, ignore_contact?, ignore_sph?",
    ),
    (
        "measurements",
        "one of density (at_secs, region?), flow_of_first (arrivals), flow_until (until_secs), evacuated ()",
    ),
    ("stop", "when_empty?, idle_secs?"),
    ("view", "region, opens_at_secs?"),
    (
        "profile",
        "one of base, navigation (goal, social or rvo; with sph?) and blend; name?, parameters?",
    ),
    ("profile.blend", "at_density, profile"),
];
