//! How accurate it is: approximations beside what they approximate, error beside cost.

pub mod walls;
