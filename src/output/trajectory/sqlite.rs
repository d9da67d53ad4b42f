//! Writes JuPedSim's SQLite format, version 2.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};
use std::{fs, io};

use rusqlite::{Connection, ToSql, params, params_from_iter};

use super::area::WalkableArea;
use super::error::Cause;
use super::{Row, Sink};
use engine::levels::Levels;
use runs::outputs::followed;
use scenario::floor_plan::to_wkt;

/// An interrupted run loses at most this much, plus one frame.
const COMMIT_EVERY: Duration = Duration::from_secs(1);

/// The tables of JuPedSim's own writer; the last four columns are ours.
const TABLES: &str = "
    CREATE TABLE trajectory_data (
        frame INTEGER NOT NULL,
        id INTEGER NOT NULL,
        pos_x REAL NOT NULL,
        pos_y REAL NOT NULL,
        ori_x REAL NOT NULL,
        ori_y REAL NOT NULL,
        density REAL NOT NULL,
        pressure REAL NOT NULL,
        speed REAL NOT NULL,
        mass REAL NOT NULL);
    CREATE INDEX frame_id_idx ON trajectory_data(frame, id);
    CREATE TABLE metadata (key TEXT NOT NULL UNIQUE PRIMARY KEY, value TEXT NOT NULL);
    CREATE TABLE geometry (hash INTEGER NOT NULL, wkt TEXT NOT NULL);
    CREATE UNIQUE INDEX geometry_hash ON geometry(hash);
    CREATE TABLE frame_data (frame INTEGER NOT NULL, geometry_hash INTEGER NOT NULL);";

/// What a building has in addition: the level and the height of each agent, and the walkable area of each level.
const OF_LEVELS: &str = "
    ALTER TABLE trajectory_data ADD COLUMN level TEXT;
    ALTER TABLE trajectory_data ADD COLUMN z REAL;
    CREATE TABLE levels (name TEXT NOT NULL UNIQUE PRIMARY KEY, wkt TEXT NOT NULL);";

/// Hash of the only geometry, used by all frames.
const GEOMETRY: i64 = 1;

/// A database that is being written.
pub struct Sqlite {
    connection: Connection,
    area: WalkableArea,
    committed_at: Instant,
    committed: u64,
    /// Frames since the last commit.
    pending: u64,
    /// Whether its rows have a level and a height.
    has_levels: bool,
}

impl Sqlite {
    /// Creates the tables in an empty file.
    pub fn create(
        path: &Path,
        area: WalkableArea,
        fps: f64,
        levels: Option<&Levels>,
    ) -> Result<Self, Cause> {
        forget_journal(path)?;
        // A relative name that begins with `file:` would be taken for a URI.
        let connection = Connection::open(fs::canonicalize(path)?)?;
        connection.execute_batch("BEGIN")?;
        connection.execute_batch(TABLES)?;
        let sqlite = Self {
            connection,
            area,
            committed_at: Instant::now(),
            committed: 0,
            pending: 0,
            has_levels: levels.is_some(),
        };
        sqlite.set("version", "2")?;
        sqlite.set("fps", &format!("{fps:?}"))?;
        sqlite.write_area()?;
        if let Some(levels) = levels {
            sqlite.connection.execute_batch(OF_LEVELS)?;
            for level in levels.all() {
                let insert = "INSERT INTO levels VALUES (?, ?)";
                let values = params![level.name, to_wkt(&level.floor)];
                sqlite.connection.execute(insert, values)?;
            }
        }
        sqlite.connection.execute_batch("COMMIT")?;
        Ok(sqlite)
    }

    fn set(&self, key: &str, value: &str) -> rusqlite::Result<usize> {
        let insert = "INSERT OR REPLACE INTO metadata VALUES (?, ?)";
        self.connection.execute(insert, params![key, value])
    }

    fn write_area(&self) -> Result<(), Cause> {
        let (wkt, bounds) = self.area.cut_out()?;
        let insert = "INSERT OR REPLACE INTO geometry VALUES (?, ?)";
        self.connection.execute(insert, params![GEOMETRY, wkt])?;
        for (key, value) in ["xmin", "ymin", "xmax", "ymax"].iter().zip(bounds) {
            self.set(key, &value.to_string())?;
        }
        Ok(())
    }

    fn insert(&self, frame: u64, rows: &[Row<'_>]) -> rusqlite::Result<()> {
        let of_level = if self.has_levels { ", ?, ?" } else { "" };
        let into_rows =
            format!("INSERT INTO trajectory_data VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?{of_level})");
        let mut insert = self.connection.prepare(&into_rows)?;
        let frame = frame.cast_signed();
        for row in rows {
            let (at, facing) = (row.place(), row.orientation());
            let place = [at.x, at.y, facing.x, facing.y];
            let values = [row.density(), row.pressure(), row.speed(), row.mass()];
            let ids: [&dyn ToSql; 2] = [&frame, &row.id()];
            let numbers = place.iter().chain(&values).map(|x| x as &dyn ToSql);
            let (level, height) = (row.level(), row.height());
            let of_level = level
                .iter()
                .flat_map(|level| [level as &dyn ToSql, &height as &dyn ToSql]);
            let all = ids.into_iter().chain(numbers).chain(of_level);
            insert.execute(params_from_iter(all))?;
        }
        let insert = "INSERT INTO frame_data VALUES (?, ?)";
        self.connection.execute(insert, params![frame, GEOMETRY])?;
        Ok(())
    }

    fn add(&mut self, frame: u64, rows: &[Row<'_>]) -> Result<(), Cause> {
        if self.connection.is_autocommit() {
            self.connection.execute_batch("BEGIN")?;
        }
        self.insert(frame, rows)?;
        if self.area.reach(rows) {
            self.write_area()?;
        }
        self.pending += 1;
        if self.committed_at.elapsed() < COMMIT_EVERY {
            return Ok(());
        }
        Ok(self.commit()?)
    }

    fn commit(&mut self) -> rusqlite::Result<()> {
        if !self.connection.is_autocommit() {
            self.connection.execute_batch("COMMIT")?;
        }
        self.committed += std::mem::take(&mut self.pending);
        self.committed_at = Instant::now();
        Ok(())
    }

    /// Discards the uncommitted frames after an error.
    fn or_forget(&mut self, result: Result<(), Cause>) -> Result<(), Cause> {
        if result.is_err() {
            self.pending = 0;
            // SQLite may have rolled back already. On a full disk, the rollback is completed by the next read.
            self.connection.execute_batch("ROLLBACK").ok();
            self.connection.execute_batch("SELECT 1 FROM geometry").ok();
        }
        result
    }
}

impl Sink for Sqlite {
    fn write(&mut self, frame: u64, rows: &[Row<'_>]) -> Result<(), Cause> {
        let added = self.add(frame, rows);
        self.or_forget(added)
    }

    fn finish(&mut self) -> Result<(), Cause> {
        let committed = self.commit();
        self.or_forget(committed.map_err(Cause::from))
    }

    fn kept(&self) -> u64 {
        self.committed
    }
}

/// Removes the journal of an interrupted run, which does not belong to the new file.
fn forget_journal(path: &Path) -> io::Result<()> {
    match fs::remove_file(journal(path)?) {
        Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
        _ => Ok(()),
    }
}

/// SQLite's journal of a database, beside the file to which symbolic links lead.
///
/// # Errors
/// A symbolic link cannot be followed.
pub fn journal(database: &Path) -> io::Result<PathBuf> {
    let mut journal = followed(database)?.into_os_string();
    journal.push("-journal");
    Ok(journal.into())
}
