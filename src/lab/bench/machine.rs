//! The machine that runs the benchmarks. Only this module names sysinfo.

use std::fmt;
use std::path::Path;

use serde::Serialize;
use sysinfo::{CpuRefreshKind, System};

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

/// Main memory that this process may use, bytes: the machine's, or the smallest limit of its control group and that
/// group's parents. `None` if the system does not report it.
pub fn main_memory() -> Option<u64> {
    let mut system = System::new();
    system.refresh_memory();
    let memory = [Some(system.total_memory()), group_limit(Path::new("/"))];
    memory
        .into_iter()
        .flatten()
        .filter(|&bytes| bytes > 0)
        .min()
}

/// The smallest memory limit of this process's control group and its parents, bytes, from the files below `root`.
/// Supports version 2 of control groups, and the memory controller of version 1.
fn group_limit(root: &Path) -> Option<u64> {
    let groups = std::fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let mounts = root.join("sys/fs/cgroup");
    let limits = groups.lines().flat_map(|line| {
        // hierarchy:controllers:path
        let mut fields = line.splitn(3, ':').skip(1);
        let (controllers, group) = (fields.next().unwrap_or(""), fields.next().unwrap_or("/"));
        let (mount, file) = match controllers {
            "" => (mounts.clone(), "memory.max"),
            _ if controllers.split(',').any(|name| name == "memory") => {
                (mounts.join("memory"), "memory.limit_in_bytes")
            }
            _ => return Vec::new(),
        };
        // In a container, parts of the path may lie outside of the mount: a missing file sets no limit.
        let groups = Path::new(group.trim_start_matches('/')).ancestors();
        let limit = |group| {
            let text = std::fs::read_to_string(mount.join(group).join(file)).ok()?;
            text.trim().parse::<u64>().ok() // `max` means no limit
        };
        groups.filter_map(limit).collect()
    });
    limits.min()
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

/// The memory of this process, bytes; only known on Linux.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Memory {
    /// Resident now.
    pub resident: u64,
    /// Peak of the resident memory.
    pub peak: u64,
}

impl Memory {
    /// The current values, if the system reports them.
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

    /// Creates the files below a temporary root and reads the limit from them.
    fn limit(files: &[(&str, &str)]) -> Option<u64> {
        let root = tempfile::tempdir().unwrap();
        for (path, text) in files {
            let path = root.path().join(path);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, text).unwrap();
        }
        group_limit(root.path())
    }

    #[test]
    fn the_smallest_limit_of_nested_groups_holds() {
        let own = ("proc/self/cgroup", "0::/user.slice/job.scope/step\n");
        let group = "sys/fs/cgroup/user.slice";
        let [outer, job, step] =
            ["", "/job.scope", "/job.scope/step"].map(|path| format!("{group}{path}/memory.max"));
        let root = ("sys/fs/cgroup/memory.max", "max\n");
        let nested = |texts: [&str; 3]| {
            let [a, b, c] = texts;
            limit(&[own, root, (&outer, a), (&job, b), (&step, c)])
        };
        assert_eq!(nested(["max\n", "max\n", "1000\n"]), Some(1000));
        assert_eq!(nested(["max\n", "500\n", "1000\n"]), Some(500));
        assert_eq!(nested(["300\n", "500\n", "max\n"]), Some(300));
        assert_eq!(nested(["max\n", "max\n", "max\n"]), None);
        // In a container, the process's own group is the root of the mount.
        assert_eq!(
            limit(&[own, ("sys/fs/cgroup/memory.max", "700\n")]),
            Some(700)
        );
    }

    #[test]
    fn the_memory_controller_of_version_1_is_read() {
        let groups = "12:cpu,cpuacct:/other\n4:memory:/slurm/job_7\n0::/\n";
        let own = ("proc/self/cgroup", groups);
        let file = |path: &str| format!("sys/fs/cgroup/memory{path}/memory.limit_in_bytes");
        let [root, outer, job] = [file(""), file("/slurm"), file("/slurm/job_7")];
        let none = "9223372036854771712\n";
        let other = ("sys/fs/cgroup/memory/other/memory.limit_in_bytes", "1\n");
        let limits = |a, b| limit(&[own, other, (&root, none), (&outer, a), (&job, b)]);
        assert_eq!(limits(none, "2000\n"), Some(2000));
        assert_eq!(limits("1500\n", "2000\n"), Some(1500));
        assert_eq!(limits(none, none), Some(9_223_372_036_854_771_712));
    }

    #[test]
    fn without_control_groups_there_is_no_limit() {
        assert_eq!(limit(&[]), None);
        assert_eq!(limit(&[("proc/self/cgroup", "0::/a\n")]), None);
    }
}
