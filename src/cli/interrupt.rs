//! SIGINT (Ctrl-C) and SIGTERM: the first signal asks a run to end, the second ends the program at once. Without a run
//! the first one does.

use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, LazyLock};

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::flag;

/// Whether no run listens: signals end the program at once.
static IDLE: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Tells whether a signal has asked the run to end. When it is dropped, signals end the program at once again.
pub struct Interrupt {
    asked: Arc<AtomicBool>,
    exit_code: Arc<AtomicUsize>,
}

impl Interrupt {
    /// Installs the signal handlers.
    ///
    /// # Errors
    /// The system refuses.
    pub fn listen() -> io::Result<Self> {
        let asked = Arc::new(AtomicBool::new(false));
        let exit_code = Arc::new(AtomicUsize::new(0));
        IDLE.store(false, Ordering::Relaxed);
        for signal in [SIGINT, SIGTERM] {
            let code = 128 + signal; // the convention of shells
            flag::register_conditional_shutdown(signal, code, Arc::clone(&IDLE))?;
            // In this order, so that the first signal does not trigger the shutdown that it enables.
            flag::register_conditional_shutdown(signal, code, Arc::clone(&asked))?;
            flag::register(signal, Arc::clone(&asked))?;
            flag::register_usize(signal, Arc::clone(&exit_code), code.unsigned_abs() as usize)?;
        }
        Ok(Self { asked, exit_code })
    }

    /// Set as soon as a signal arrives.
    pub fn flag(&self) -> Arc<AtomicBool> {
        Arc::clone(&self.asked)
    }

    /// The exit code of the interrupted run, if a signal arrived.
    pub fn exit_code(&self) -> Option<u8> {
        match self.exit_code.load(Ordering::Relaxed) {
            0 => None,
            code => u8::try_from(code).ok(),
        }
    }
}

impl Drop for Interrupt {
    fn drop(&mut self) {
        IDLE.store(true, Ordering::Relaxed);
    }
}
