//! A board on the PC: a card in memory that fails on demand, a display model, threads for harts.
#![allow(dead_code)]

use std::cell::Cell;
use std::fmt;
use std::path::{Path, PathBuf};
use std::process::Command;

use embedded_sdmmc::{Block, BlockCount, BlockDevice, BlockIdx};
use mipidsi::options::{Orientation, Rotation};
use player::card::Card;
use player::fault::{CardFault, Fault};
use player::pair::Harts;
use player::play::{Board, Storage, play};
use scanout::math::Q16;
use scanout_display::flush::BlockingInterface;
use scanout_display::init::Setup;
use scanout_display::model::{DisplayModel, Glass, ModelError, NoDelay, Picture};

/// How the display is turned.
pub const TURNED: Orientation = Orientation { rotation: Rotation::Deg90, mirrored: false };

pub fn models() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/system-b")
}

/// A file of a card: path and bytes.
pub type File<'a> = (&'a str, Vec<u8>);

/// A model of system B as it lies in the repository.
pub fn model_file(name: &str) -> Vec<u8> {
    std::fs::read(models().join(name)).unwrap()
}

/// An image made by the script that users call.
pub fn image(bare: bool, files: &[File<'_>]) -> Vec<u8> {
    static COUNT: std::sync::atomic::AtomicU32 = std::sync::atomic::AtomicU32::new(0);
    let number = COUNT.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    let work = std::env::temp_dir().join(format!("player-{}-{number}", std::process::id()));
    let folder = work.join("card");
    for (path, bytes) in files {
        let path = folder.join(path);
        std::fs::create_dir_all(path.parent().unwrap()).unwrap();
        std::fs::write(path, bytes).unwrap();
    }
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("../sd-image");
    let mut command = Command::new(script);
    if bare {
        command.arg("--bare");
    }
    let status = command.arg(work.join("sd.img")).arg(&folder).status().unwrap();
    assert!(status.success(), "firmware/sd-image failed; apt-get install dosfstools mtools");
    let image = std::fs::read(work.join("sd.img")).unwrap();
    std::fs::remove_dir_all(work).unwrap();
    image
}

/// A card with one of system B's models.
pub fn card_with(model: &str, show: &str) -> Vec<u8> {
    let (obj, ppm) = (format!("models/{model}.obj"), format!("models/{model}.ppm"));
    image(
        false,
        &[
            ("show.txt", format!("model {obj}\ntexture {ppm}\n{show}").into_bytes()),
            (&obj, model_file(&format!("{model}.obj"))),
            (&ppm, model_file(&format!("{model}.ppm"))),
        ],
    )
}

/// What a test's card does wrong.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Prank {
    /// Nothing.
    None,
    /// There is no card, for so many starts.
    Missing(u32),
    /// It is pulled out after so many sectors, and in again at the next start.
    PulledAfter(u32),
    /// Each sector from this one on comes with a wrong checksum so many times in a row.
    Checksum(u32, u32),
    /// It refuses this sector.
    Refuse(u32),
}

#[derive(Debug)]
pub struct CardError(CardFault);

impl fmt::Display for CardError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:?}", self.0)
    }
}

impl std::error::Error for CardError {}

/// A card in memory.
pub struct MemoryCard {
    pub image: Vec<u8>,
    pub prank: Cell<Prank>,
    pub reads: Cell<u32>,
    wrong: Cell<(u32, u32)>,
}

impl MemoryCard {
    pub fn new(image: Vec<u8>, prank: Prank) -> Self {
        MemoryCard { image, prank: prank.into(), reads: Cell::new(0), wrong: Cell::default() }
    }
}

impl BlockDevice for MemoryCard {
    type Error = CardError;

    fn read(&self, blocks: &mut [Block], start: BlockIdx) -> Result<(), CardError> {
        for (block, sector) in blocks.iter_mut().zip(start.0..) {
            self.reads.set(self.reads.get() + 1);
            match self.prank.get() {
                Prank::PulledAfter(0) => return Err(CardError(CardFault::Gone)),
                Prank::PulledAfter(left) => self.prank.set(Prank::PulledAfter(left - 1)),
                Prank::Checksum(from, times) if sector >= from => {
                    let (last, count) = self.wrong.get();
                    let count = if last == sector { count } else { 0 };
                    if count < times {
                        self.wrong.set((sector, count + 1));
                        return Err(CardError(CardFault::Checksum));
                    }
                }
                Prank::Refuse(which) if sector == which => {
                    return Err(CardError(CardFault::Refused));
                }
                _ => {}
            }
            let at = sector as usize * 512;
            let bytes = self.image.get(at..at + 512).ok_or(CardError(CardFault::Refused))?;
            block.contents.copy_from_slice(bytes);
        }
        Ok(())
    }

    fn write(&self, _: &[Block], _: BlockIdx) -> Result<(), CardError> {
        unreachable!("firmware writes nothing")
    }

    fn num_blocks(&self) -> Result<BlockCount, CardError> {
        Ok(BlockCount((self.image.len() / 512) as u32))
    }
}

impl Card for MemoryCard {
    fn start(&self) -> Result<(), CardError> {
        match self.prank.get() {
            Prank::Missing(0) => self.prank.set(Prank::None),
            Prank::Missing(left) => {
                self.prank.set(Prank::Missing(left - 1));
                return Err(CardError(CardFault::Missing));
            }
            Prank::PulledAfter(0) => self.prank.set(Prank::None),
            _ => {}
        }
        Ok(())
    }

    fn fault(error: &CardError) -> CardFault {
        error.0
    }
}

/// A display that may fall silent.
pub struct Bus {
    pub model: DisplayModel,
    /// Transfers that still fail, once those before are through.
    pub silent: u32,
    pub after: u32,
}

#[derive(Debug)]
pub enum BusError {
    Silent,
    Model(ModelError),
}

impl Bus {
    fn ready(&mut self) -> Result<(), BusError> {
        if self.after > 0 {
            self.after -= 1;
        } else if self.silent > 0 {
            self.silent -= 1;
            return Err(BusError::Silent);
        }
        Ok(())
    }
}

impl BlockingInterface for Bus {
    type Error = BusError;

    fn command(&mut self, command: u8, parameters: &[u8]) -> Result<(), BusError> {
        self.ready()?;
        self.model.feed(command, false).map_err(BusError::Model)?;
        self.model.feed_all(parameters, true).map_err(BusError::Model)
    }

    fn data(&mut self, bytes: &[u8]) -> Result<(), BusError> {
        self.ready()?;
        self.model.feed_all(bytes, true).map_err(BusError::Model)
    }
}

/// Threads for harts.
pub struct Threads;

impl Harts for Threads {
    const TWO: bool = true;

    fn join(&self, here: &mut dyn FnMut(), there: &mut (dyn FnMut() + Send)) {
        std::thread::scope(|scope| {
            scope.spawn(there);
            here();
        });
    }
}

/// A board.
pub struct Pc {
    pub card: MemoryCard,
    pub bus: Bus,
    pub harts: Threads,
    /// Lines of the serial port.
    pub said: Vec<String>,
    /// The one being said.
    line: Vec<u8>,
    /// Hashes of the frames that the display showed, from 1.
    pub hashes: Vec<u64>,
    /// Pictures of the messages.
    pub messages: Vec<Picture<u16>>,
    /// Faults told, and how many are borne.
    pub faults: Vec<Fault>,
    pub patience: usize,
}

impl Board for Pc {
    type Card = MemoryCard;
    type Bus = Bus;
    type Harts = Threads;

    fn parts(&mut self) -> (&MemoryCard, &mut Bus, &Threads) {
        (&self.card, &mut self.bus, &self.harts)
    }

    fn start_display(&mut self) -> Result<(), BusError> {
        Setup { orientation: TURNED, ..Setup::default() }.start(&mut self.bus, &mut NoDelay)
    }

    fn say(&mut self, text: &[u8]) {
        for &byte in text {
            match byte {
                b'\n' => {
                    let line = std::mem::take(&mut self.line);
                    self.said.push(String::from_utf8(line).unwrap());
                }
                _ => self.line.push(byte),
            }
        }
    }

    fn frame_sent(&mut self, number: u32) {
        let picture = self.bus.model.picture().unwrap().upright(TURNED);
        assert_eq!(self.bus.model.untouched(), 0, "each pixel is written");
        self.bus.model.forget();
        if number == 0 {
            self.messages.push(picture);
        } else {
            self.hashes.push(picture.hash());
            assert_eq!(self.hashes.len(), number as usize);
        }
    }

    fn again(&mut self, fault: &Fault) -> bool {
        self.faults.push(fault.clone());
        self.faults.len() <= self.patience
    }
}

impl Pc {
    pub fn new(image: Vec<u8>, prank: Prank) -> Self {
        Pc {
            card: MemoryCard::new(image, prank),
            bus: Bus { model: DisplayModel::new(Glass::default()), silent: 0, after: 0 },
            harts: Threads,
            said: Vec::new(),
            line: Vec::new(),
            hashes: Vec::new(),
            messages: Vec::new(),
            faults: Vec::new(),
            patience: 0,
        }
    }

    /// Runs it in as much memory as the emulated board has.
    pub fn play(&mut self) -> Result<(), Fault> {
        let mut storage = new_storage();
        play(self, &mut storage.lend())
    }
}

/// As large as system B's: 500 positions, 500 quads; a texture of 250 x 250.
pub type Memory = Storage<500, 1000, 62_500, 1920>;

pub fn new_storage() -> Box<Memory> {
    Box::new(Memory::new())
}

/// The hashes of a model's first frames as the PC makes them.
pub fn expected(name: &str, textured: bool, scale: Q16, frames: u32) -> Vec<u64> {
    let picture = textured.then(|| models().join(format!("{name}.ppm")));
    let obj = models().join(format!("{name}.obj"));
    monitor::expected::hashes(&obj, picture.as_deref(), None, scale, frames).unwrap()
}

/// Moves every cluster but the first of each file and folder to some other place.
pub fn fragment(image: &mut [u8], volume: usize) {
    let two = |image: &[u8], at: usize| u16::from_le_bytes([image[at], image[at + 1]]) as usize;
    let four = |image: &[u8], at: usize| two(image, at) | two(image, at + 2) << 16;
    let cluster = image[volume + 13] as usize * 512;
    let fat = volume + two(image, volume + 14) * 512;
    let fat_size = four(image, volume + 36) * 512;
    let data = fat + image[volume + 16] as usize * fat_size;
    let entry = |number: usize| fat + 4 * number;
    let clusters = (image.len() - data) / cluster;
    let end = 0x0fff_fff8;
    let links: Vec<usize> = (2..clusters)
        .filter(|&c| (2..end).contains(&(four(image, entry(c)) & 0x0fff_ffff)))
        .collect();
    // From the end backwards in strides, so that neighbours part.
    let mut free = (1000..clusters).rev().step_by(7);
    let mut moved = std::collections::HashMap::new();
    for from in links {
        let from = moved.get(&from).copied().unwrap_or(from);
        let old = four(image, entry(from)) & 0x0fff_ffff;
        let new = free.find(|&c| four(image, entry(c)) == 0).unwrap();
        image.copy_within(
            data + (old - 2) * cluster..data + (old - 1) * cluster,
            data + (new - 2) * cluster,
        );
        image[data + (old - 2) * cluster..data + (old - 1) * cluster].fill(0xa5);
        image.copy_within(entry(old)..entry(old) + 4, entry(new));
        image[entry(old)..entry(old) + 4].fill(0);
        image[entry(from)..entry(from) + 4].copy_from_slice(&(new as u32).to_le_bytes());
        moved.insert(old, new);
    }
}
