//! What is measured on. The only place that names sysinfo.

use std::fmt;

use serde::Serialize;
use sysinfo::{CpuRefreshKind, System};

/// The machine, as far as times depend on it.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Physical cores that the system sees.
    pub cores: usize,
    /// Threads that run at once.
    pub hardware_threads: usize,
    /// Main memory, bytes.
    pub memory_bytes: u64,
    /// The system and its kernel.
    pub system: String,
    /// How many threads wanted to run at once over the last minute, before anything was measured: what
    /// else the machine does.
    pub load: f64,
}

impl Machine {
    /// This one.
    pub fn here() -> Self {
        let mut system = System::new();
        system.refresh_memory();
        system.refresh_cpu_list(CpuRefreshKind::nothing());
        let hardware_threads = system.cpus().len().max(1);
        let brand = system.cpus().first().map_or("", |cpu| cpu.brand().trim());
        let named = |text: &str| {
            if text.is_empty() {
                "unknown".to_owned()
            } else {
                text.to_owned()
            }
        };
        let name = System::long_os_version().unwrap_or_default();
        Self {
            cpu: named(brand),
            cores: System::physical_core_count().unwrap_or(hardware_threads),
            hardware_threads,
            memory_bytes: system.total_memory(),
            system: format!("{}, {}", named(name.trim()), System::kernel_long_version()),
            load: System::load_average().one,
        }
    }
}

/// Main memory that this process may use, bytes: the machine's, or less where its control group has a
/// limit; `None` where the system does not say.
pub fn main_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory();
    let limit = system.cgroup_limits().map(|limits| limits.total_memory);
    let memory = [Some(system.total_memory()), limit];
    memory
        .into_iter()
        .flatten()
        .filter(|&bytes| bytes > 0)
        .min()
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let gibibytes = self.memory_bytes as f64 / f64::from(1 << 30);
        write!(
            f,
            "{}, {} core(s), {} thread(s) at once, {gibibytes:.1} GiB, {}, load {:.1}",
            self.cpu, self.cores, self.hardware_threads, self.system, self.load
        )
    }
}

/// How much memory this process holds, bytes; only Linux says.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Resident now.
    pub resident: u64,
    /// The most that ever was.
    pub peak: u64,
}

impl Memory {
    /// Now, if the system says so.
    pub fn now() -> Option<Self> {
        Self::read(&std::fs::read_to_string("/proc/self/status").ok()?)
    }

    /// From the text of `/proc/self/status`.
    pub fn read(status: &str) -> Option<Self> {
        let bytes = |key: &str| -> Option<u64> {
            let line = status.lines().find_map(|line| line.strip_prefix(key))?;
            let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
            Some(1024 * kibibytes)
        };
        Some(Self {
            resident: bytes("VmRSS:")?,
            peak: bytes("VmHWM:")?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_is_read_in_bytes_or_not_at_all() {
        let status = "Name:\tsandbox\nVmHWM:\t    2048 kB\nVmRSS:\t    1024 kB\n";
        let memory = Memory::read(status).unwrap();
        assert_eq!((memory.resident, memory.peak), (1 << 20, 1 << 21));
        assert_eq!(Memory::read("VmRSS:\t 1024 kB\n"), None);
    }
}
