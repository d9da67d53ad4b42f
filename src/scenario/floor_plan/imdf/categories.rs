//! What the categories of units are: the words of IMDF 1.0.

/// What a unit is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// People walk on it.
    Floor,
    /// A wall, a column or another body.
    Solid,
    /// There is no floor.
    Hole,
    /// A flight that leads to another level.
    Stairs,
    /// A flight that leads to another level, or a few steps within one.
    Steps,
    /// A slope that leads to another level.
    Ramp,
    /// Left out, with a note.
    Unused,
}

/// The words for each category; for those with parts, such as `restroom.female`, the first part.
const WORDS: [(Category, &[&str]); 7] = [
    (
        Category::Floor,
        &[
            "walkway",
            "room",
            "corridor",
            "hall",
            "landing",
            "lobby",
            "auditorium",
            "classroom",
            "conferenceroom",
            "fieldofplay",
            "firstaid",
            "fitnessroom",
            "foodservice",
            "footbridge",
            "huddleroom",
            "kitchen",
            "laboratory",
            "library",
            "lounge",
            "mailroom",
            "mothersroom",
            "movietheater",
            "nonpublic",
            "office",
            "parking",
            "phoneroom",
            "platform",
            "privatelounge",
            "recreation",
            "restroom",
            "serverroom",
            "shower",
            "smokingarea",
            "storage",
            "terrace",
            "theater",
            "unenclosedarea",
            "unspecified",
            "waitingroom",
        ],
    ),
    (
        Category::Solid,
        &[
            "structure",
            "column",
            "brick",
            "concrete",
            "drywall",
            "glass",
            "wood",
            "vegetation",
        ],
    ),
    (Category::Hole, &["opentobelow"]),
    (Category::Stairs, &["stairs", "stair"]),
    (Category::Steps, &["steps"]),
    (Category::Ramp, &["ramp"]),
    (
        Category::Unused,
        &["elevator", "escalator", "movingwalkway", "road"],
    ),
];

impl Category {
    /// The category that a word means, in any case; `None` if it means none.
    pub fn of_word(word: &str) -> Option<Self> {
        let word = word.trim().to_lowercase();
        let first = word.split('.').next().unwrap_or_default();
        let mut all = WORDS.iter();
        let found = all.find(|(_, words)| words.contains(&first));
        found.map(|(category, _)| *category)
    }

    /// All words.
    pub fn words() -> impl Iterator<Item = &'static str> {
        WORDS.iter().flat_map(|(_, words)| words.iter().copied())
    }

    /// Whether it is a level of its own.
    pub fn is_flight(self) -> bool {
        matches!(self, Self::Stairs | Self::Steps | Self::Ramp)
    }
}
