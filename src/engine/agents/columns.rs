//! The arrays of agents: how they are arranged in another order.

use std::any::{Any, TypeId};
use std::collections::HashMap;

use rayon::prelude::*;

use crate::math::Vector;

/// From this number of agents on, arrays are arranged in parallel.
const SOME: usize = 4096;
/// From this number of agents on, the parts of each array are arranged in parallel.
const MANY: usize = 50_000;

/// Moves entry `order[k]` of all columns to index k. Entries that are not in `order` are removed.
pub fn arrange<'a>(
    columns: impl Iterator<Item = &'a mut dyn Column>,
    order: &[u32],
    spare: &mut Spare,
) {
    if order.len() >= MANY {
        return columns.for_each(|column| column.arrange(order, spare));
    }
    let mut columns: Vec<&mut dyn Column> = columns.collect();
    spare.each.resize_with(columns.len(), Spare::default);
    let least = if order.len() >= SOME {
        1
    } else {
        columns.len()
    };
    let each = columns.par_iter_mut().zip(&mut spare.each);
    each.with_min_len(least)
        .for_each(|(column, spare)| column.arrange(order, spare));
}

/// Arrays of one type.
pub fn of<T: Column>(arrays: &mut [T]) -> impl Iterator<Item = &mut dyn Column> {
    arrays.iter_mut().map(|array| array as &mut dyn Column)
}

/// An array with one entry per agent.
pub trait Column: Send {
    /// The number of its entries.
    fn count(&self) -> usize;

    /// Adds default entries up to this number.
    fn extend_to(&mut self, count: usize);

    /// Moves entry `order[k]` to index k.
    fn arrange(&mut self, order: &[u32], spare: &mut Spare);
}

/// Arrays of the types of columns, in which columns are arranged: allocated once, not for every sort.
#[derive(Debug, Default)]
pub struct Spare {
    arrays: HashMap<TypeId, Box<dyn Any + Send + Sync>>,
    /// Those of each column, if there are few agents.
    each: Vec<Spare>,
}

impl Spare {
    /// With many agents, arrays of larger values are allocated for every sort.
    const LARGEST: usize = size_of::<Vector>();

    /// An array of this type, with any values.
    fn take<T: Send + Sync + 'static>(&mut self) -> Vec<T> {
        let array = self.arrays.get_mut(&TypeId::of::<T>());
        let array = array.and_then(|array| array.downcast_mut::<Vec<T>>());
        array.map(std::mem::take).unwrap_or_default()
    }

    /// Gives an array back.
    fn put<T: Send + Sync + 'static>(&mut self, array: Vec<T>) {
        if size_of::<T>() <= Self::LARGEST || array.len() < MANY {
            self.arrays.insert(TypeId::of::<T>(), Box::new(array));
        }
    }
}

impl Clone for Spare {
    /// No memory: a copy allocates its own.
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<T: Copy + Default + Send + Sync + 'static> Column for Vec<T> {
    fn count(&self) -> usize {
        self.len()
    }

    fn extend_to(&mut self, count: usize) {
        self.resize(count, T::default());
    }

    fn arrange(&mut self, order: &[u32], spare: &mut Spare) {
        let mut arranged = spare.take::<T>();
        arranged.clear();
        let order = order.par_iter().with_min_len(MANY / 2);
        arranged.par_extend(order.map(|&i| self[i as usize]));
        spare.put(std::mem::replace(self, arranged));
    }
}
