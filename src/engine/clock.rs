//! Time, counted in whole frames (§5.1): most steps run every Δt_fine, a few every Δt_coarse.

/// Δt_fine of the paper, seconds.
pub const PAPER_TIME_STEP: f64 = 0.02;
/// Δt_coarse of the paper, seconds.
pub const PAPER_COARSE_STEP: f64 = 0.1;

/// The shortest Δt_fine that a scenario may have, seconds.
pub const SHORTEST_TIME_STEP: f64 = 1e-6;

/// How the state is advanced by one frame (§5).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Integrator {
    /// v ← clamp(v + a Δt), then r ← r + v Δt with the new v.
    #[default]
    SemiImplicit,
    /// r ← r + v Δt with the old v, and v ← clamp(v + a Δt).
    ForwardEuler,
    /// r ← r + v Δt + a Δt²/2, and v with the mean of the accelerations at both ends of the step. Forces that depend
    /// on velocity see the prediction v + a Δt, which is also the velocity of a frame; its error is O(Δt²).
    VelocityVerlet,
    /// The midpoint method (second-order Runge-Kutta): evaluates all forces but RVO again half a frame later, and
    /// takes the whole step with the velocity and acceleration found there.
    Midpoint,
}

impl Integrator {
    /// All of them.
    pub const ALL: [Self; 4] = [
        Self::SemiImplicit,
        Self::ForwardEuler,
        Self::VelocityVerlet,
        Self::Midpoint,
    ];
}

/// Counts fine frames. Times are derived from the count.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Clock {
    frame: u64,
    time_step: f64,
    coarse_every: u32,
}

impl Clock {
    /// A clock at frame 0 with Δt_fine = `time_step` seconds and Δt_coarse = `coarse_every` frames.
    pub fn new(time_step: f64, coarse_every: u32) -> Self {
        Self {
            frame: 0,
            time_step,
            coarse_every: coarse_every.max(1),
        }
    }

    /// The number of frames of `time_step` seconds that comes nearest to the paper's Δt_coarse.
    pub fn nearest_coarse_every(time_step: f64) -> u32 {
        (PAPER_COARSE_STEP / time_step).round().max(1.0) as u32
    }

    /// A clock at frame 0 with the paper's Δt_coarse and the longest Δt_fine up to `longest` seconds that divides it
    /// into equal frames: pushes and entries then happen at the times of the paper's clock. Steps longer than the
    /// paper's Δt_coarse are coarse frames themselves.
    pub fn up_to(longest: f64) -> Self {
        if longest >= PAPER_COARSE_STEP {
            return Self::new(longest, 1);
        }
        // Decimal steps are rarely exact fractions.
        let frames = (PAPER_COARSE_STEP / longest - 1e-6).ceil().max(1.0);
        Self::new(PAPER_COARSE_STEP / frames, frames as u32)
    }

    /// The current frame, from 0.
    pub fn frame(&self) -> u64 {
        self.frame
    }

    /// The time at the current frame, seconds.
    pub fn time(&self) -> f64 {
        self.time_at(self.frame)
    }

    /// The time at `frame`, seconds.
    pub fn time_at(&self, frame: u64) -> f64 {
        frame as f64 * self.time_step
    }

    /// The frame nearest to a time in seconds.
    pub fn frame_at(&self, time: f64) -> u64 {
        (time / self.time_step).round() as u64
    }

    /// The first coarse frame at or after a time in seconds.
    pub fn coarse_frame_at(&self, time: f64) -> u64 {
        // Tolerates rounding: decimal times are rarely exact multiples of the time step.
        let frame = (time / self.time_step - 1e-6).ceil() as u64;
        frame.next_multiple_of(u64::from(self.coarse_every))
    }

    /// Δt_fine in seconds.
    pub fn time_step(&self) -> f64 {
        self.time_step
    }

    /// Δt_coarse in fine frames.
    pub fn coarse_every(&self) -> u32 {
        self.coarse_every
    }

    /// Δt_coarse in seconds.
    pub fn coarse_step(&self) -> f64 {
        f64::from(self.coarse_every) * self.time_step
    }

    /// Whether the current frame is a coarse one.
    pub fn is_coarse(&self) -> bool {
        self.frame.is_multiple_of(u64::from(self.coarse_every))
    }

    /// The number of the current coarse frame, from 0.
    pub fn coarse_frame(&self) -> u64 {
        self.frame / u64::from(self.coarse_every)
    }

    /// Jumps to any frame.
    pub fn go_to(&mut self, frame: u64) {
        self.frame = frame;
    }

    /// Advances to the next frame.
    pub fn advance(&mut self) {
        self.frame += 1;
    }
}

impl Default for Clock {
    fn default() -> Self {
        Self::new(PAPER_TIME_STEP, Self::nearest_coarse_every(PAPER_TIME_STEP))
    }
}
