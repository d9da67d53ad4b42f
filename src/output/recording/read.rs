//! Reads recordings back: the crowd in every frame, the outlines of walls, the scenario, the results.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::Path;

use rerun::external::arrow::array::{Array as _, ArrayRef, AsArray as _};
use rerun::external::arrow::compute::cast;
use rerun::external::arrow::datatypes::{DataType, Float64Type};
use rerun::external::re_log_types::StoreKind;
use rerun::{ChunkStore, ChunkStoreConfig, EntityPath, TimelineName};

use super::error::RecordingError;
use super::frame::{FRAME, SIM_TIME, crowd};
use super::text;
use engine::math::Vector;

const POSITIONS: &str = "Points2D:positions";
const RADII: &str = "Points2D:radii";
const WALLS: &str = "world/geometry/walls";
const STRIPS: &str = "LineStrips2D:strips";
const TEXT: &str = "TextDocument:text";
/// The beginning of the names of our own values.
const OWN: &str = "agent:";
/// The ends of the names of values that are colors.
const COLORS: &str = "colors";
/// The marks around the scenario in the text of a recording.
const DOCUMENT: [&str; 2] = ["```json\n", "\n```"];

/// A value of the crowd by frame: the number of the frame, and one entry per agent.
type Rows = Vec<(i64, ArrayRef)>;

/// A recording in memory.
pub struct Recorded {
    /// The number and the time, seconds, of each frame.
    frames: Vec<(i64, f64)>,
    crowd: BTreeMap<String, Rows>,
    walls: Vec<Vec<Vector>>,
    text: String,
    report: Option<String>,
}

/// The crowd in a frame of a recording.
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedCrowd {
    /// Unique numbers.
    pub ids: Vec<i64>,
    /// Meters.
    pub positions: Vec<Vector>,
    /// Meters.
    pub radii: Vec<f64>,
}

impl Recorded {
    /// Reads a recording.
    ///
    /// # Errors
    /// The file cannot be read, is damaged, or has no crowd.
    pub fn read(path: &Path) -> Result<Self, RecordingError> {
        let unread = |reason: String| RecordingError::Unread {
            path: path.to_owned(),
            reason,
        };
        let mut file = File::open(path).map_err(|error| unread(error.to_string()))?;
        let found = ChunkStore::from_rrd_reader(&ChunkStoreConfig::ALL_DISABLED, &mut file);
        let read = found.map_err(|error| unread(format!("{error:#}")))?;
        let mut stores = read.into_iter();
        let store = stores.find(|(id, _)| id.kind() == StoreKind::Recording);
        let (_, store) = store.ok_or_else(|| unread("it has no recording".to_owned()))?;
        let mut recorded = Self {
            frames: Vec::new(),
            crowd: BTreeMap::new(),
            walls: Vec::new(),
            text: String::new(),
            report: None,
        };
        recorded.add(&store);
        match recorded.frames.is_empty() {
            true => Err(unread(format!("it has no crowd at {}", crowd::ENTITY))),
            false => Ok(recorded),
        }
    }

    /// Adds the rows of the crowd, the walls and the text.
    fn add(&mut self, store: &ChunkStore) {
        let [agents, walls, document, report] =
            [crowd::ENTITY, WALLS, text::DOCUMENT, text::REPORT].map(EntityPath::from);
        let [frame, time] = [FRAME, SIM_TIME].map(TimelineName::from_static_str);
        for chunk in store.iter_physical_chunks() {
            let entity = chunk.entity_path();
            let times = |timeline| chunk.timelines().get(&timeline);
            for component in chunk.components_identifiers() {
                let row = |row| chunk.component_batch_raw(component, row)?.ok();
                match component.as_str() {
                    STRIPS if *entity == walls => self.walls.extend(row(0).iter().flat_map(strips)),
                    TEXT if *entity == document => {
                        self.text.extend(row(0).as_ref().and_then(words))
                    }
                    TEXT if *entity == report => self.report = row(0).as_ref().and_then(words),
                    name if *entity == agents => {
                        let (Some(frames), Some(secs)) = (times(frame), times(time)) else {
                            continue;
                        };
                        let whole = frames.times_raw().iter().zip(secs.times_raw()).enumerate();
                        for (k, (&frame, &nanoseconds)) in whole {
                            let Some(values) = row(k) else { continue };
                            if name == POSITIONS {
                                self.frames.push((frame, nanoseconds as f64 * 1e-9));
                            }
                            let rows = self.crowd.entry(name.to_owned()).or_default();
                            rows.push((frame, values));
                        }
                    }
                    _ => {}
                }
            }
        }
        self.frames.sort_by_key(|&(frame, _)| frame);
        for rows in self.crowd.values_mut() {
            rows.sort_by_key(|&(frame, _)| frame);
        }
    }

    /// The time of each frame, seconds, ascending.
    pub fn times(&self) -> impl ExactSizeIterator<Item = f64> {
        self.frames.iter().map(|&(_, time)| time)
    }

    /// The crowd in the `k`-th frame.
    pub fn crowd(&self, k: usize) -> RecordedCrowd {
        let row = self.latest(k, POSITIONS);
        let values = row.and_then(|row| numbers(row.as_fixed_size_list_opt()?.values()));
        let flat = values.unwrap_or_default();
        let positions: Vec<Vector> = flat
            .chunks_exact(2)
            .map(Vector::from_column_slice)
            .collect();
        let count = positions.len();
        let of_agents = |name: &str| {
            let values = self.latest(k, name).and_then(numbers);
            values.filter(|values| values.len() == count)
        };
        let ids = of_agents("agent:id").map(|ids| ids.into_iter().map(|id| id as i64).collect());
        RecordedCrowd {
            ids: ids.unwrap_or_else(|| (0..count as i64).collect()),
            radii: of_agents(RADII).unwrap_or_else(|| vec![0.0; count]),
            positions,
        }
    }

    /// The names of the values that the recording has for its agents.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        let names = self.crowd.keys().filter_map(|name| name.strip_prefix(OWN));
        names.filter(|name| !name.ends_with(COLORS) && *name != "id")
    }

    /// Values of the agents in the `k`-th frame, in the order of [`crowd`](Self::crowd).
    pub fn values(&self, k: usize, name: &str) -> Option<Vec<f64>> {
        numbers(self.latest(k, &format!("{OWN}{name}"))?)
    }

    /// The outlines of the walls; each edge has the solid on its left.
    pub fn walls(&self) -> &[Vec<Vector>] {
        &self.walls
    }

    /// The scenario, in JSON, if the recording is one of a run.
    pub fn scenario(&self) -> Option<&str> {
        let [begin, end] = DOCUMENT;
        let (_, rest) = self.text.split_once(begin)?;
        rest.split_once(end).map(|(scenario, _)| scenario)
    }

    /// The results of the run, in JSON, if it has ended.
    pub fn report(&self) -> Option<&str> {
        self.report.as_deref()
    }

    /// The title.
    pub fn title(&self) -> Option<&str> {
        self.text.lines().next()?.strip_prefix("# ")
    }

    /// The row that is valid in the `k`-th frame.
    fn latest(&self, k: usize, name: &str) -> Option<&ArrayRef> {
        let (rows, (frame, _)) = (self.crowd.get(name)?, self.frames.get(k)?);
        let next = rows.partition_point(|(number, _)| number <= frame);
        Some(&rows.get(next.checked_sub(1)?)?.1)
    }
}

fn numbers(array: &ArrayRef) -> Option<Vec<f64>> {
    let floats = cast(array, &DataType::Float64).ok()?;
    let numbers = floats.as_primitive_opt::<Float64Type>()?;
    Some(numbers.values().to_vec())
}

/// Lines without their last point if it is the first one again.
fn strips(row: &ArrayRef) -> Vec<Vec<Vector>> {
    let Some(lists) = row.as_list_opt::<i32>() else {
        return Vec::new();
    };
    let strip = |k: usize| {
        let list = lists.value(k);
        let numbers = numbers(list.as_fixed_size_list_opt()?.values())?;
        let mut points: Vec<Vector> = numbers
            .chunks_exact(2)
            .map(Vector::from_column_slice)
            .collect();
        if points.first() == points.last() {
            points.pop();
        }
        Some(points)
    };
    (0..lists.len()).filter_map(strip).collect()
}

fn words(row: &ArrayRef) -> Option<String> {
    let words = row.as_string_opt::<i32>()?;
    (!words.is_empty()).then(|| words.value(0).to_owned())
}
