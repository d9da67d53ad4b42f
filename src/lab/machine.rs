//! The machine and the memory of this process. Only this module names sysinfo.

use std::fmt;

use indicatif::HumanBytes;
use serde::Serialize;
use sysinfo::{
    CpuRefreshKind, Process, ProcessRefreshKind, ProcessesToUpdate, System, get_current_pid,
};

/// The properties of the machine that affect times.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Machine {
    /// The processor's name.
    pub cpu: String,
    /// Physical cores that the system reports.
    pub cores: usize,
    /// Hardware threads.
    pub hardware_threads: usize,
    /// Main memory, bytes.
    pub memory_bytes: u64,
    /// The operating system and its kernel.
    pub system: String,
    /// Average number of runnable threads in the minute before the measurements: the load by other programs.
    pub load: f64,
}

impl Machine {
    /// The current machine.
    pub fn here() -> Self {
        let mut system = System::new();
        system.refresh_memory();
        system.refresh_cpu_list(CpuRefreshKind::nothing());
        let hardware_threads = system.cpus().len().max(1);
        let named = |text: &str| match text.trim() {
            "" => "unknown".to_owned(),
            text => text.to_owned(),
        };
        let name = System::long_os_version().unwrap_or_default();
        Self {
            cpu: named(system.cpus().first().map_or("", |cpu| cpu.brand())),
            cores: System::physical_core_count().unwrap_or(hardware_threads),
            hardware_threads,
            memory_bytes: system.total_memory(),
            system: format!("{}, {}", named(&name), System::kernel_long_version()),
            load: System::load_average().one,
        }
    }
}

impl fmt::Display for Machine {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(
            f,
            "{}, {} core(s), {} hardware thread(s), {}, {}, load {:.1}",
            self.cpu,
            self.cores,
            self.hardware_threads,
            HumanBytes(self.memory_bytes),
            self.system,
            self.load
        )
    }
}

/// Main memory that this process may use, bytes: the machine's, or the smallest limit of its control group and that
/// group's parents. `None` if the system does not report it.
pub fn main_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory();
    let own = get_current_pid().ok();
    let own_group = own.and_then(|own| {
        let only = ProcessesToUpdate::Some(&[own]);
        system.refresh_processes_specifics(only, false, ProcessRefreshKind::nothing());
        system.process(own).and_then(Process::cgroup_limits)
    });
    // In a container the process's group may lie outside of the mount, whose root is then the container's group.
    let group = own_group.or_else(|| system.cgroup_limits());
    let limit = group.map_or(u64::MAX, |group| group.total_memory);
    Some(system.total_memory().min(limit)).filter(|&bytes| bytes > 0)
}

/// The resident memory of this process, bytes; only known on Linux.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Resident {
    /// The current value.
    pub now: u64,
    /// The peak.
    pub peak: u64,
}

impl Resident {
    /// The current values, if the system reports them.
    pub fn read() -> Option<Self> {
        Self::parse(&std::fs::read_to_string("/proc/self/status").ok()?)
    }

    /// From the text of `/proc/self/status`.
    pub fn parse(status: &str) -> Option<Self> {
        let bytes = |key: &str| -> Option<u64> {
            let line = status.lines().find_map(|line| line.strip_prefix(key))?;
            let kibibytes: u64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
            Some(1024 * kibibytes)
        };
        Some(Self {
            now: bytes("VmRSS:")?,
            peak: bytes("VmHWM:")?,
        })
    }
}
