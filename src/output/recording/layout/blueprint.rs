//! Sends the layout that a recording opens with.

use rerun::blueprint::BlueprintActivation;
use rerun::external::re_log_types::{BlueprintActivationCommand, LogMsg, StoreKind};
use rerun::{RecordingStream, RecordingStreamBuilder};

use super::{Content, Opening, layout};
use crate::recording::error::Cause;
use crate::recording::options::RecordingOptions;
use crate::recording::stream::application;

/// Sends the default blueprint.
pub fn send(
    stream: &RecordingStream,
    options: &RecordingOptions,
    opening: Opening,
    content: &Content,
) -> Result<(), Cause> {
    let (blueprint, properties) = layout(options, opening, content);
    let (memory, storage) = RecordingStreamBuilder::new(application(options)?)
        .send_properties(false)
        .memory()?;
    let flags = BlueprintActivation {
        make_active: true,
        make_default: true,
    };
    blueprint.send(&memory, flags)?;
    let own = |message: &LogMsg| {
        message.store_id().kind() == StoreKind::Blueprint
            && !matches!(message, LogMsg::BlueprintActivationCommand(_))
    };
    let mut messages: Vec<LogMsg> = storage.take().into_iter().filter(own).collect();
    let Some(id) = messages.first().map(|message| message.store_id().clone()) else {
        return Ok(());
    };
    let (extra, extra_storage) = RecordingStreamBuilder::from_store_id(&id)
        .send_properties(false)
        .memory()?;
    extra.set_time_sequence("blueprint", 0);
    for (entity, value) in &properties {
        extra.log(entity.clone(), value.as_ref())?;
    }
    let is_data = |message: &LogMsg| matches!(message, LogMsg::ArrowMsg(..));
    messages.extend(extra_storage.take().into_iter().filter(is_data));
    let activation = BlueprintActivationCommand {
        blueprint_id: id,
        make_active: true,
        make_default: true,
    };
    stream.send_blueprint(messages, activation);
    Ok(())
}
