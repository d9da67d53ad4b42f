//! Steps 3, 3B and 4: one file per force, one pure function per equation.
//!
//! Every function reads the frozen [`Frame`](crate::frame::Frame) and returns, or adds, its contribution to
//! accelerations in m/s², divided by mass or density. Sums over agents are computed for eight agents at a time;
//! `near` sums pressure, viscosity and contact in one pass.

pub mod contact;
pub mod drag;
pub mod goal;
pub mod legs;
pub mod model;
#[doc(hidden)]
pub mod near;
pub mod own;
#[doc(hidden)]
pub mod pressure;
pub mod push;
pub mod rates;
pub mod rvo;
pub mod social;
#[doc(hidden)]
pub mod virial;
pub mod viscosity;
pub mod walking;
