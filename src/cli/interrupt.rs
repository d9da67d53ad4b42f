//! Ctrl-C and a plain `kill`: the first asks a run to end, the next ends the program at once.

use std::io;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Somebody may ask the run to end.
pub struct Interrupt {
    exit_code: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Listens from now on, and as long as the program runs.
    ///
    /// # Errors
    /// The system does not let it.
    pub fn listen() -> io::Result<Self> {
        let asked = Arc::new(AtomicBool::new(false));
        let exit_code = Arc::new(AtomicUsize::new(0));
        for signal in [SIGINT, SIGTERM] {
            let code = 128 + signal; // as shells have it
            // In this order: a signal's own mark does not end the program.
            flag::register_conditional_shutdown(signal, code, Arc::clone(&asked))?;
            flag::register(signal, Arc::clone(&asked))?;
            flag::register_usize(signal, Arc::clone(&exit_code), code.unsigned_abs() as usize)?;
        }
        Ok(Self { exit_code })
    }

    /// The exit code of a run that ends because it was asked to, if it was.
    pub fn exit_code(&self) -> Option<u8> {
        match self.exit_code.load(Ordering::Relaxed) {
            0 => None,
            code => u8::try_from(code).ok(),
        }
    }
}
