//! Blocks at their places → entities with the map to the drawing.

use super::entities::{Content, Entity, Insert};
use super::file::{Block, Drawing, LAYER_OF_BLOCK};
use super::map::Map;
use crate::error::quote::shown;
use crate::floor_plan::error::FloorPlanError;

/// Most entities of a drawing, with each block counted wherever it is inserted.
const MOST_ENTITIES: usize = 2_000_000;
/// Blocks within blocks are at most this deep.
const DEEPEST: usize = 64;

/// An entity at a place.
#[derive(Debug, Clone, Copy)]
pub struct Placed<'a> {
    /// The entity.
    pub entity: &'a Entity,
    /// From its coordinates to those of the drawing.
    pub map: Map,
    /// The number of its layer.
    pub layer: usize,
    /// The name that the attributes of a block give it.
    pub name: Option<&'a str>,
    /// The number of the outermost block that it is part of.
    pub block: Option<usize>,
}

/// All entities of a drawing at their places, without the INSERTs themselves.
pub fn placed(drawing: &Drawing) -> Result<Vec<Placed<'_>>, FloorPlanError> {
    let mut placing = Placing {
        drawing,
        path: Vec::new(),
        found: Vec::new(),
        count: 0,
        blocks: 0,
    };
    let within = Within {
        map: Map::SAME,
        layer: LAYER_OF_BLOCK,
        name: None,
        block: None,
    };
    placing.add(&drawing.entities, within)?;
    Ok(placing.found)
}

/// Where the entities of a block are.
#[derive(Clone, Copy)]
struct Within<'a> {
    map: Map,
    layer: usize,
    name: Option<&'a str>,
    block: Option<usize>,
}

struct Placing<'a> {
    drawing: &'a Drawing,
    /// The names of the blocks that the current one is part of.
    path: Vec<&'a str>,
    found: Vec<Placed<'a>>,
    /// The number of entities and blocks up to now.
    count: usize,
    /// The number of outermost blocks up to now.
    blocks: usize,
}

impl<'a> Placing<'a> {
    fn add(&mut self, entities: &'a [Entity], within: Within<'a>) -> Result<(), FloorPlanError> {
        for entity in entities {
            self.count += 1;
            if self.count > MOST_ENTITIES {
                return Err(self.wrong(
                    entity,
                    format!("with its blocks, the drawing has more than {MOST_ENTITIES} entities; leave some out"),
                ));
            }
            let layer = match entity.layer {
                LAYER_OF_BLOCK => within.layer,
                layer => layer,
            };
            let here = Within { layer, ..within };
            match &entity.content {
                Content::Insert(insert) => self.add_block(entity, insert, here)?,
                _ => self.found.push(Placed {
                    entity,
                    map: within.map.after(&entity.plane),
                    layer,
                    name: within.name,
                    block: within.block,
                }),
            }
        }
        Ok(())
    }

    fn add_block(
        &mut self,
        entity: &'a Entity,
        insert: &'a Insert,
        within: Within<'a>,
    ) -> Result<(), FloorPlanError> {
        let name = insert.block.as_str();
        let drawing = self.drawing;
        let Some(block) = drawing.blocks.get(name) else {
            // Counts as an entity that is not read.
            self.found.push(Placed {
                entity,
                map: within.map.after(&entity.plane),
                layer: within.layer,
                name: None,
                block: None,
            });
            return Ok(());
        };
        if drawing.layers.all()[within.layer].is_frozen || block.entities.is_empty() {
            return Ok(());
        }
        if self.path.contains(&name) || self.path.len() >= DEEPEST {
            let reason = match self.path.contains(&name) {
                true => format!("the block \"{}\" contains itself; explode it", shown(name)),
                false => format!("blocks within blocks are more than {DEEPEST} deep; explode them"),
            };
            return Err(self.wrong(entity, reason));
        }
        self.path.push(name);
        let block_number = within.block.unwrap_or(self.blocks);
        let within = Within {
            name: insert.name.as_deref().or(within.name),
            block: Some(block_number),
            ..within
        };
        self.add_copies(entity, (insert, block), within)?;
        self.blocks = self.blocks.max(block_number + 1);
        self.path.pop();
        Ok(())
    }

    /// Adds all copies of a block.
    fn add_copies(
        &mut self,
        entity: &'a Entity,
        (insert, block): (&'a Insert, &'a Block),
        within: Within<'a>,
    ) -> Result<(), FloorPlanError> {
        let inserted = within
            .map
            .after(&entity.plane)
            .after(&Map::shift(insert.at))
            .after(&Map::turn(insert.turn));
        let base = Map::shift(block.base.map(|x| -x));
        let own = Map::scale(insert.scale).after(&base);
        for row in 0..insert.counts[1] {
            for column in 0..insert.counts[0] {
                let [right, up] = insert.distances;
                let copy = Map::shift([right * column as f64, up * row as f64]);
                let map = inserted.after(&copy).after(&own);
                self.add(&block.entities, Within { map, ..within })?;
            }
        }
        Ok(())
    }

    fn wrong(&self, entity: &Entity, reason: String) -> FloorPlanError {
        let place = place(entity, &self.drawing.layers.all()[entity.layer].name);
        FloorPlanError::Geometry { place, reason }
    }
}

/// The name of an entity in messages.
pub fn place(entity: &Entity, layer: &str) -> String {
    let handle = match &*entity.handle {
        "" => String::new(),
        handle => format!(" {handle}"),
    };
    format!(
        "{}{handle} on layer \"{layer}\" ({})",
        entity.kind, entity.at
    )
}
