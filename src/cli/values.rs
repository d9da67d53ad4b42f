//! Whole numbers as typed, and what is said about those that are none.

pub fn seed(text: &str) -> Result<u64, &'static str> {
    text.parse()
        .map_err(|_| "not a whole number from 0 to 2^64 - 1")
}

pub fn id(text: &str) -> Result<u32, &'static str> {
    text.parse()
        .map_err(|_| "not an agent's id, a whole number from 0")
}

pub fn every_frames(text: &str) -> Result<u64, &'static str> {
    match text.parse() {
        Ok(frames @ 1..) => Ok(frames),
        _ => Err("not a number of frames, 1 or more"),
    }
}
