//! The native part of the Python package `sandbox_crowds`: the program, and simulations frame by frame. Conversions
//! only; `sandbox_crowds/*.py` has the interface.

#![warn(clippy::unwrap_used)]

mod events;
mod given;
mod model;
mod simulation;
mod values;

use std::ffi::OsString;
use std::sync::OnceLock;

use pyo3::create_exception;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sandbox::cli::main_with;
use sandbox::output::trajectory::Columns;
use sandbox::scenario::SHIPPED;

use simulation::Native;

create_exception!(
    sandbox_crowds,
    Error,
    PyValueError,
    "A scenario, a setting or an argument is invalid, or the simulation failed. The message names the place and the \
     fix."
);

/// The error with this message.
fn error(message: impl ToString) -> PyErr {
    Error::new_err(message.to_string())
}

/// Refuses to simulate in a process that was forked from one that has simulated: it does not have its threads.
fn check_process() -> PyResult<()> {
    static FIRST: OnceLock<u32> = OnceLock::new();
    let own = std::process::id();
    if *FIRST.get_or_init(|| own) == own {
        return Ok(());
    }
    Err(error(
        "this process was forked from one that has simulated, and has no threads: start it with \
         multiprocessing.get_context(\"spawn\")",
    ))
}

/// Runs the program with these arguments and returns its exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    let name = OsString::from("sandbox");
    py.detach(|| main_with([name].into_iter().chain(arguments)))
}

/// The names of all columns of trajectories, with their meanings and units.
#[pyfunction]
fn columns() -> Vec<(&'static str, &'static str)> {
    Columns::all().collect()
}

/// The names of the scenarios that come with the program.
#[pyfunction]
fn scenarios() -> Vec<&'static str> {
    SHIPPED.iter().map(|shipped| shipped.name).collect()
}

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("Error", module.py().get_type::<Error>())?;
    module.add_class::<Native>()?;
    module.add_function(wrap_pyfunction!(main, module)?)?;
    module.add_function(wrap_pyfunction!(columns, module)?)?;
    module.add_function(wrap_pyfunction!(scenarios, module)?)
}
