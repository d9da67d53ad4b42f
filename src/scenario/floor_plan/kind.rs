//! What the shapes of a plan are, by the words that plans use for them: in English, German and French.

/// What a shape of a plan is. All but the first three leave the floor as it is: a scenario refers to them by name.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Kind {
    /// Walkable area.
    #[default]
    Floor,
    /// A body that stands on the floor.
    Obstacle,
    /// A wall: a line that nobody passes, or an obstacle.
    Wall,
    /// A door between rooms.
    Door,
    /// Where people leave.
    Exit,
    /// Where people enter.
    Entrance,
    /// Where people are at the beginning.
    Crowd,
    /// What people pass on their way.
    Waypoint,
    /// Where people wait.
    WaitingArea,
    /// A line on which people stand.
    Queue,
    /// An area in which people walk slower or faster, such as stairs.
    Zone,
    /// Anything else with a name.
    Place,
}

/// The words for each kind, in lowercase and in the singular: first the one that lists show.
const WORDS: [(Kind, &[&str]); 12] = [
    (
        Kind::Floor,
        &[
            "floor",
            "walkable",
            "walkablearea",
            "walkable area",
            "room",
            "corridor",
            "raum",
            "bodenfläche",
        ],
    ),
    (
        Kind::Obstacle,
        &[
            "obstacle",
            "column",
            "col",
            "pillar",
            "furniture",
            "furn",
            "fixture",
            "barrier",
            "stütze",
            "stuetze",
            "säule",
            "saeule",
            "möbel",
            "moebel",
            "möblierung",
            "moeblierung",
            "poteau",
            "mobilier",
        ],
    ),
    (
        Kind::Wall,
        &[
            "wall",
            "partition",
            "fence",
            "railing",
            "window",
            "glaz",
            "wand",
            "wände",
            "waende",
            "mauer",
            "fenster",
            "mur",
        ],
    ),
    (
        Kind::Door,
        &["door", "opening", "tür", "tuer", "türen", "tueren", "porte"],
    ),
    (
        Kind::Exit,
        &[
            "exit",
            "ausgang",
            "ausgänge",
            "notausgang",
            "notausgänge",
            "sortie",
        ],
    ),
    (
        Kind::Entrance,
        &[
            "entrance",
            "entry",
            "source",
            "eingang",
            "eingänge",
            "entrée",
        ],
    ),
    (Kind::Crowd, &["crowd", "distribution", "people", "spawn"]),
    (Kind::Waypoint, &["waypoint", "checkpoint"]),
    (Kind::WaitingArea, &["waiting area", "waiting"]),
    (Kind::Queue, &["queue"]),
    (
        Kind::Zone,
        &[
            "zone",
            "stair",
            "strs",
            "stairs",
            "escalator",
            "ramp",
            "treppe",
            "treppen",
            "rampe",
            "escalier",
        ],
    ),
    (Kind::Place, &["place", "journey"]),
];

impl Kind {
    /// The kind that a word means, in any case, in the singular or the plural; `None` if it means none.
    pub fn of_word(word: &str) -> Option<Self> {
        let word = word.trim().to_lowercase().replace(['_', '-'], " ");
        let singular = word.strip_suffix('s').unwrap_or(&word);
        let means = |known: &&str| **known == word || **known == *singular;
        let mut kinds = WORDS.iter();
        let found = kinds.find(|(_, words)| words.iter().any(&means));
        found.map(|(kind, _)| *kind)
    }

    /// The kind that a layer's name means, as `A-WALL`, `jps-exits` or `Main doors`: that of its last part that means
    /// one; `None` if no part does.
    pub fn of_layer(name: &str) -> Option<Self> {
        let whole = Self::of_word(name);
        let mut parts = name.split(|c: char| !c.is_alphabetic()).rev();
        whole.or_else(|| parts.find_map(Self::of_word))
    }

    /// The word for it in lists and messages.
    pub fn word(self) -> &'static str {
        let mut kinds = WORDS.iter();
        let found = kinds.find(|(kind, _)| *kind == self);
        found.map_or("place", |(_, words)| words[0])
    }

    /// The words for all kinds in lists and messages.
    pub fn words() -> impl Iterator<Item = &'static str> {
        WORDS.iter().map(|(_, words)| words[0])
    }

    /// Whether it is part of the floor plan, not only a place on it.
    pub fn is_built(self) -> bool {
        matches!(self, Self::Floor | Self::Obstacle | Self::Wall)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn layers_are_known_by_the_last_word_that_means_a_kind() {
        let kinds = [
            "A-WALL",
            "jps-walkablearea",
            "jps-distributions",
            "Main doors",
            "S_COLS",
            "0",
        ];
        let found = kinds.map(Kind::of_layer);
        let of = Some;
        assert_eq!(
            found,
            [
                of(Kind::Wall),
                of(Kind::Floor),
                of(Kind::Crowd),
                of(Kind::Door),
                of(Kind::Obstacle),
                None
            ]
        );
    }

    #[test]
    fn every_kind_has_a_word_of_its_own() {
        for (kind, words) in WORDS {
            assert_eq!(
                (Kind::of_word(words[0]), kind.word()),
                (Some(kind), words[0])
            );
        }
    }
}
