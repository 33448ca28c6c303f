//! The machine that prices hold for.

use serde::{Deserialize, Serialize};

/// What of a machine is worth printing beside a price.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Machine {
    /// Model of the processor, where the system tells.
    pub processor: Option<String>,
    /// Cores that this program may use.
    pub cores: usize,
    /// Operating system and architecture.
    pub system: String,
    /// Programs that wanted to run in the last minute, on the average, where the system tells.
    pub load: Option<f64>,
}

impl Machine {
    /// The machine that this runs on.
    #[must_use]
    pub fn this() -> Self {
        let told = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            processor: processor(&told),
            cores: std::thread::available_parallelism().map_or(1, usize::from),
            system: format!("{} {}", std::env::consts::OS, std::env::consts::ARCH),
            load: load(&std::fs::read_to_string("/proc/loadavg").unwrap_or_default()),
        }
    }

    /// Whether something else ran, so that prices are not those of a quiet machine.
    #[must_use]
    pub fn is_busy(&self) -> bool {
        self.load.is_some_and(|load| load > LOAD_MAX)
    }

    /// The machine in a few words.
    #[must_use]
    pub fn describe(&self) -> String {
        let processor = self.processor.as_deref().unwrap_or("processor unknown");
        format!("{processor}, {} cores, {}", self.cores, self.system)
    }
}

/// A load above this is no quiet machine.
const LOAD_MAX: f64 = 0.5;

/// The first number of Linux's averages.
fn load(averages: &str) -> Option<f64> {
    averages.split_whitespace().next()?.parse().ok()
}

/// The first model name of Linux's table of processors.
fn processor(table: &str) -> Option<String> {
    let lines = table.lines().filter_map(|line| line.split_once(':'));
    let named = lines.filter(|(key, _)| key.trim() == "model name");
    let mut names = named.map(|(_, name)| name.trim().to_owned());
    names.find(|name| !name.is_empty())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_processor_is_named_where_the_system_tells() {
        let table = "processor\t: 0\nmodel name\t: Some CPU @ 2.00GHz\nflags\t: a b\n";
        assert_eq!(processor(table).as_deref(), Some("Some CPU @ 2.00GHz"));
        assert_eq!(processor(""), None);
    }

    #[test]
    fn the_load_is_told_where_the_system_tells() {
        assert_eq!(load("1.93 1.69 0.88 3/200 13102\n"), Some(1.93));
        assert_eq!(load(""), None);
    }
}
