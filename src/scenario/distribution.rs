//! placeholder
use super::error::Problem;
use crate::engine::distribution::Distribution;
use schemars::JsonSchema;
use serde::Deserialize;

/// A number.
#[derive(Debug, Clone, PartialEq, Deserialize, JsonSchema)]
#[serde(transparent)]
pub(super) struct Amount(f64);

impl Amount {
    pub(super) fn distribution(&self) -> Result<Distribution, Problem> {
        Ok(Distribution::Constant(self.0))
    }
}
