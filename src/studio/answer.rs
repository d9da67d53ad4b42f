//! Answers to requests, and why a request is refused.

use std::fmt::Display;

use scenario::ScenarioError;
use serde_json::{Value, json};

/// An answer.
#[derive(Debug, Clone, PartialEq)]
pub struct Answer {
    /// The status of HTTP.
    pub status: u16,
    /// The type of the content.
    pub kind: &'static str,
    /// The content.
    pub content: Vec<u8>,
    /// The name under which a browser keeps it.
    pub file: Option<String>,
}

impl Answer {
    /// Content of a type.
    pub fn of(kind: &'static str, content: impl Into<Vec<u8>>) -> Self {
        Self {
            status: 200,
            kind,
            content: content.into(),
            file: None,
        }
    }

    /// JSON.
    pub fn json(value: &Value) -> Self {
        Self::of("application/json", value.to_string())
    }
}

/// A request that cannot be met.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{message}")]
pub struct Refusal {
    /// The status of HTTP.
    pub status: u16,
    /// The place in the scenario: a key path, or nothing.
    pub path: String,
    /// The reason.
    pub reason: String,
    /// The whole sentence.
    pub message: String,
}

impl Refusal {
    /// A request that is wrong.
    pub fn wrong(message: impl Into<String>) -> Self {
        Self::with(400, message)
    }

    /// A failure of the program or of the system.
    pub fn failed(error: impl Display) -> Self {
        Self::with(500, error.to_string())
    }

    /// A request that is right, for what is not possible now.
    pub fn impossible(error: impl Display) -> Self {
        Self::with(422, error.to_string())
    }

    /// A request with a status of HTTP.
    pub fn with(status: u16, message: impl Into<String>) -> Self {
        let message = message.into();
        Self {
            status,
            path: String::new(),
            reason: message.clone(),
            message,
        }
    }

    /// As the page reads it.
    pub fn document(&self) -> Value {
        json!({"path": self.path, "reason": self.reason, "message": self.message})
    }

    /// The answer.
    pub fn answer(&self) -> Answer {
        Answer {
            status: self.status,
            ..Answer::json(&json!({"error": self.document()}))
        }
    }
}

impl From<ScenarioError> for Refusal {
    fn from(error: ScenarioError) -> Self {
        let message = error.to_string();
        let (path, reason) = match error {
            ScenarioError::Invalid { problem, .. } | ScenarioError::Setting { problem, .. } => {
                (problem.path, problem.reason)
            }
            _ => (String::new(), message.clone()),
        };
        Self {
            status: 422,
            path,
            reason,
            message,
        }
    }
}
