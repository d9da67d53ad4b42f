//! Compiles the crate again after a change in `scenarios/`: its files are built into the program, and a new one would
//! be missing.

fn main() {
    println!("cargo::rerun-if-changed=../../scenarios");
}
