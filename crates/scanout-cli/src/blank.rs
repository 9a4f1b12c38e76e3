//! A picture on which nothing is to be seen is told, with what would help.
//!
//! Where counts don't tell what hides the models, the picture is drawn without it.

use crate::args::{CameraArgs, DrawMode};
use crate::draw::{self, Frame, Options};
use crate::error::Result;
use crate::narrate;
use crate::scene_builder::{Shot, Stage, Without};

/// Says on standard error why nothing is to be seen on this frame, if so.
///
/// # Errors
/// As [`draw::frame`].
pub fn tell(
    stage: &mut Stage,
    shot: &Shot,
    options: &Options,
    camera: &CameraArgs,
    frame: &Frame,
) -> Result<()> {
    let pixels = &frame.picture.pixels;
    if stage.background_is_plain() && !options.dither && pixels.iter().any(|p| *p != pixels[0]) {
        return Ok(()); // the usual case, without a second look
    }
    let empty = without(stage, Without::Objects, shot, options)?;
    if frame.bytes == empty.bytes {
        let why = reason(stage, shot, options, camera, frame, &empty)?;
        narrate!("scanout: nothing is to be seen: {why}");
    }
    Ok(())
}

/// The same for the first of many frames.
///
/// # Errors
/// As [`draw::frame`].
pub fn tell_first(
    stage: &mut Stage,
    shot: &Shot,
    options: &Options,
    camera: &CameraArgs,
) -> Result<()> {
    let frame = draw::frame(stage, shot, options)?;
    tell(stage, shot, options, camera, &frame)
}

fn without(stage: &mut Stage, what: Without, shot: &Shot, options: &Options) -> Result<Frame> {
    stage.without = Some(what);
    let frame = draw::frame(stage, shot, options);
    stage.without = None;
    frame
}

/// What is wrong, and what to do.
fn reason(
    stage: &mut Stage,
    shot: &Shot,
    options: &Options,
    camera: &CameraArgs,
    frame: &Frame,
    empty: &Frame,
) -> Result<&'static str> {
    let lines = matches!(stage.mode(), DrawMode::Wire | DrawMode::Hidden);
    if stage.mode() != DrawMode::Points && !stage.has_triangles() {
        if !stage.has_edges() {
            return Ok("the model has points only; use --mode points");
        }
        if !lines {
            return Ok("the model has edges and no faces; use --mode wire");
        }
    }
    let mut helps = |what| Ok(without(stage, what, shot, options)?.bytes != empty.bytes);
    if frame.reports.iter().any(|report| report.stats.back_facing > 0) && helps(Without::Culling)? {
        return Ok("all faces in view turn their backs to the camera; use --two-sided");
    }
    if helps(Without::Fog)? {
        return Ok("the fog hides all; give --fog distances farther away, or leave it away");
    }
    if frame.reports.iter().any(|report| report.stats.primitives > 0) {
        return Ok("it has the background's colour; change --background, --color or the light");
    }
    let placed = camera.camera_position.is_some()
        || camera.camera_focal_point.is_some()
        || camera.eye.is_some();
    Ok(if placed || camera.zoom > 1.0 {
        "the model lies outside the view; leave the camera options away, then it fills the view"
    } else {
        "the model covers no middle of a pixel; enlarge --resolution"
    })
}
