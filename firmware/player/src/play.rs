//! The loop: start the display and the card, read what is to be shown, show it. A fault is written on the display and on
//! the serial port; then everything is tried again, or what can go on goes on.
//!
//! | fault | what happens |
//! |---|---|
//! | the display takes no data | told on the serial port, tried again |
//! | the card, its files, the model | told on both, tried again from the card's start |
//! | the display fails while frames run | told on the serial port; it is started again and the frames go on |
//! | the texture alone can't be had | told on both for a moment; the model is shown without it |
//!
//! Once the model is in memory the card is not needed any more: pulling it out changes nothing.

use core::cell::Cell;
use core::ops::ControlFlow;

use scanout::frame::{Frame, ObjectState, Primitive, Settings, Store};
use scanout::transform::Vertex;
use scanout_assets::text::{Value, fill};
use scanout_display::flush::BlockingInterface;
use scanout_display::window::Area;

use crate::card::{Card, Cost, Files, with_files};
use crate::fault::{Failed, Fault, Faults, FileFault};
use crate::message::{self, Words};
use crate::model::{Built, ModelMemory, ObjReader, Picture, PpmReader, Totals};
use crate::pair::{self, Buffers, Harts, Wrong};
use crate::scene::{self, HEIGHT, WIDTH};
use crate::show::{self, Show};

/// Where the frame lies on the display.
pub const AREA: Area = Area::LANDSCAPE;

/// What the loop needs of a board.
pub trait Board {
    /// The SD card.
    type Card: Card;
    /// The display's bus.
    type Bus: BlockingInterface<Error: Send> + Send;
    /// Its harts.
    type Harts: Harts;

    /// The card and the harts.
    fn parts(&mut self) -> (&Self::Card, &mut Self::Bus, &Self::Harts);

    /// Starts the display.
    ///
    /// # Errors
    /// What its bus says.
    fn start_display(&mut self) -> Result<(), <Self::Bus as BlockingInterface>::Error>;

    /// Text on the serial port, UTF-8; a line ends with a line feed.
    fn say(&mut self, text: &[u8]);

    /// A frame has been sent.
    fn frame_sent(&mut self, _number: u32) {}

    /// A fault has been told; waits about a second. False: give up, which a machine in a box never does.
    fn again(&mut self, fault: &Fault) -> bool;
}

/// Memory for everything but the board's own.
#[derive(Debug)]
pub struct Memory<'m> {
    /// The model.
    pub model: ModelMemory<'m>,
    /// Prepared vertices, one a position.
    pub vertices: &'m mut [Vertex],
    /// Prepared primitives, one a triangle.
    pub primitives: &'m mut [Primitive],
    /// Bands.
    pub buffers: Buffers<'m>,
}

/// All memory in one piece, for a static: V positions, normals and texture coordinates, T triangles, X texels,
/// four bands of B pixels.
#[derive(Debug)]
pub struct Storage<const V: usize, const T: usize, const X: usize, const B: usize> {
    millionths: [[i32; 3]; V],
    positions: [[i16; 3]; V],
    normals: [[i16; 3]; V],
    uvs: [[i32; 2]; V],
    triangles: [[[u16; 3]; T]; 2],
    face_normals: [[i16; 3]; T],
    vertices: [Vertex; V],
    primitives: [Primitive; T],
    bands: [[u16; B]; 4],
    texels: [u16; X],
}

impl<const V: usize, const T: usize, const X: usize, const B: usize> Storage<V, T, X, B> {
    /// Bytes without the texels.
    pub const BYTES: usize = size_of::<Self>() - 2 * X;

    /// Zeros, as a static's initial value: it takes no room in flash and never lies on a stack.
    #[allow(clippy::new_without_default)] // a default would be built on the stack
    pub const fn new() -> Self {
        Storage {
            millionths: [[0; 3]; V],
            positions: [[0; 3]; V],
            normals: [[0; 3]; V],
            uvs: [[0; 2]; V],
            triangles: [[[0; 3]; T]; 2],
            face_normals: [[0; 3]; T],
            vertices: [Vertex::EMPTY; V],
            primitives: [Primitive::EMPTY; T],
            bands: [[0; B]; 4],
            texels: [0; X],
        }
    }

    /// Lends it.
    pub fn lend(&mut self) -> Memory<'_> {
        let [triangles, uv_triangles] = &mut self.triangles;
        let [front, back, near, far] = &mut self.bands;
        Memory {
            model: ModelMemory {
                millionths: &mut self.millionths,
                positions: &mut self.positions,
                normals: &mut self.normals,
                uvs: &mut self.uvs,
                triangles,
                uv_triangles,
                face_normals: &mut self.face_normals,
                texels: &mut self.texels,
            },
            vertices: &mut self.vertices,
            primitives: &mut self.primitives,
            buffers: Buffers { colour: [front, back], depth: [near, far] },
        }
    }
}

/// What was loaded.
struct Loaded {
    show: Show,
    built: Built,
    picture: Option<Picture>,
}

/// Runs until the frames that were asked for are shown, or [`Board::again`] gives up.
///
/// # Errors
/// The fault that it gave up at.
pub fn play<B: Board>(board: &mut B, memory: &mut Memory<'_>) -> Result<(), Fault> {
    let (mut display, faults) = (false, Faults::default());
    let loaded = loop {
        if !display {
            display = board.start_display().is_ok();
            if !display && !told(board, memory, false, &Fault::Display) {
                return Err(Fault::Display);
            }
            if !display {
                continue;
            }
        }
        let cost = Cell::new(Cost::default());
        let (card, ..) = board.parts();
        let result = with_files(card, &cost, &faults, |files| load(files, &mut memory.model));
        if let Ok(loaded) = &result {
            report(board, loaded, cost.get());
        }
        // Why there is nothing to show, or no texture though one was asked for.
        if let Some(fault) = faults.take()
            && !told(board, memory, true, &fault)
        {
            return Err(fault);
        }
        match result {
            Ok(loaded) => break loaded,
            // Whatever is on the display now, it is started afresh: it may have been pulled out, too.
            Err(Failed) => display = false,
        }
    };
    frames(board, memory, &loaded)
}

#[inline(never)]
fn report<B: Board>(board: &mut B, loaded: &Loaded, cost: Cost) {
    let Totals { positions, normals, uvs, triangles } = loaded.built.totals;
    let Cost { bytes, sectors, repeated } = cost;
    let number = |number: u32| Value::Number(number as usize);
    let values = [
        Value::Text(&loaded.show.model),
        Value::Number(positions),
        Value::Number(uvs),
        Value::Number(normals),
        Value::Number(triangles),
        number(bytes),
        number(sectors),
        number(repeated),
    ];
    fill(
        "%: % v, % vt, % vn, % triangles\n% bytes of files, % sectors read, % of them again\n",
        &values,
        &mut |text| board.say(text),
    );
}

/// Tells a fault on the serial port and, where it works, on the display; then waits.
fn told<B: Board>(board: &mut B, memory: &mut Memory<'_>, display: bool, fault: &Fault) -> bool {
    say_fault(board, fault);
    if display {
        let mut words = Words::new();
        fault.tell(&mut |text| message::append(&mut words, text));
        let (_, bus, _) = board.parts();
        let colour = &mut *memory.buffers.colour[0];
        let shown = message::show(bus, AREA, colour, b"scanout can't go on:", &words);
        match shown {
            Ok(()) => board.frame_sent(0),
            Err(_) => say_fault(board, &Fault::Display),
        }
    }
    board.again(fault)
}

fn say_fault<B: Board>(board: &mut B, fault: &Fault) {
    board.say(b"fault: ");
    fault.tell(&mut |text| board.say(text));
    board.say(b"\n");
}

/// Reads the model and its texture. Without the texture it goes on, and why there is none is left in the files' faults.
#[inline(never)]
fn load<C: Card>(files: &Files<'_, '_, C>, memory: &mut ModelMemory<'_>) -> Result<Loaded, Failed> {
    let faults = files.faults;
    let show = settings(files)?;
    let told = |fault| faults.leave_file(&show.model, fault);
    let mut reader = ObjReader::new(memory);
    files.read(&show.model, &mut |chunk| {
        reader.feed(chunk).map_err(told)?;
        Ok(ControlFlow::Continue(()))
    })?;
    let built = reader.finish().map_err(told)?;
    let picture = texture(files, &show.texture, memory);
    // The card's own faults are tried again; the model does without a picture that is no good.
    if faults.is(|fault| matches!(fault, Fault::Card { .. } | Fault::Damaged(_))) {
        return Err(Failed);
    }
    Ok(Loaded { show, built, picture })
}

/// What `show.txt` says, if there is one.
#[inline(never)]
fn settings<C: Card>(files: &Files<'_, '_, C>) -> Result<Show, Failed> {
    let faults = files.faults;
    let (mut text, mut length) = ([0; 1024], 0);
    let read = files.read("show.txt", &mut |chunk| {
        let room = text.get_mut(length..length + chunk.len());
        let too_long = || faults.leave(Fault::Show { line: 1, what: "longer than 1024 bytes" });
        room.ok_or_else(too_long)?.copy_from_slice(chunk);
        length += chunk.len();
        Ok(ControlFlow::Continue(()))
    });
    if read.is_err() {
        if !faults.is(|fault| matches!(fault, Fault::File(_, FileFault::Missing))) {
            return Err(Failed);
        }
        faults.take();
    }
    let mut show = Show::default();
    show.read(&text[..length]).map_err(|fault| faults.leave(fault))?;
    Ok(show)
}

/// The picture at `path`; none where that is empty, or with a fault.
#[inline(never)]
fn texture<C: Card>(
    files: &Files<'_, '_, C>,
    path: &str,
    memory: &mut ModelMemory<'_>,
) -> Option<Picture> {
    if path.is_empty() {
        return None;
    }
    let told = |fault| files.faults.leave_file(path, fault);
    let mut reader = PpmReader::new(memory.texels);
    files
        .read(path, &mut |chunk| {
            reader.feed(chunk).map_err(told)?;
            Ok(if reader.is_done() { ControlFlow::Break(()) } else { ControlFlow::Continue(()) })
        })
        .ok()?;
    reader.finish().map_err(told).ok()
}

#[inline(never)]
fn frames<B: Board>(board: &mut B, memory: &mut Memory<'_>, loaded: &Loaded) -> Result<(), Fault> {
    let Loaded { show, built, picture } = loaded;
    let sharing = show.harts.unwrap_or(show::Harts::Relay);
    let sharing = if <B::Harts as Harts>::TWO { sharing } else { show::Harts::One };
    let mut number = 0;
    while show.frames == 0 || number < show.frames {
        let Memory { model, vertices, primitives, buffers } = memory;
        let model = built.model(model, *picture);
        let result = scene::with_scene(&model, show.scale, number, |scene| {
            let mut objects = [ObjectState::default()];
            let store = Store { vertices, primitives, objects: &mut objects };
            let frame = Frame::prepare(scene, Settings::new(WIDTH, HEIGHT), store)
                .map_err(|_| Wrong::Memory)?;
            let (_, bus, harts) = board.parts();
            pair::show(&frame, bus, AREA, buffers, harts, sharing)
        });
        match result {
            Ok(()) => {
                board.frame_sent(number + 1);
                number += 1;
            }
            // The same frame again, once the display takes it.
            Err(Wrong::Bus) => loop {
                if !told(board, memory, false, &Fault::Display) {
                    return Err(Fault::Display);
                }
                if board.start_display().is_ok() {
                    break;
                }
            },
            Err(Wrong::Memory) => {
                told(board, memory, true, &Fault::Frame);
                return Err(Fault::Frame);
            }
        }
    }
    Ok(())
}
