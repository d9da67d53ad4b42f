//! Finished experiments: measurements that answered a question once, and can be repeated. Their findings are in the
//! documents named below. They are no part of the program `sandbox`, whose benchmarks they extend.
//!
//! | experiment | question | findings |
//! |---|---|---|
//! | [`domains`] | how would crowds divide among processes? | docs/findings/scaling.md |
//! | [`compare`] | how fast are other engines on the same crowds? | docs/findings/performance.md |
//! | [`costs`] | what would the errors of estimates cost with presets? | docs/findings/accuracy.md |
//! | [`intervals`] | how often do the intervals of estimates hold the value? | docs/findings/accuracy.md |
//! | [`physics`] | do crowds of the model do what crowds did in known experiments? | docs/findings/questions.md |
//! | [`symmetric`] | would sums that visit each pair once pay? | docs/findings/performance.md |
//! | [`walls`] | how accurate are the integrals over walls by this and other methods? | docs/findings/accuracy.md |

#![warn(clippy::unwrap_used)]

pub mod compare;
pub mod costs;
pub mod domains;
pub mod intervals;
pub mod physics;
pub mod symmetric;
pub mod walls;
