//! An algorithm in Rust: sort and sweep along one axis (Ericson 2005, 7.5), in worlds where bodies
//! come and go, with pairs or events as its answer.
//!
//!   rustc -O --crate-type cdylib sweep.rs
//!   broadmark --headless fountain --plugin ./libsweep.so --algorithm rust-sweep --answer events

use std::ffi::{c_char, c_void};
use std::panic::{catch_unwind, AssertUnwindSafe};

// broadmark_plugin.h, version 1.

#[repr(C)]
#[derive(Clone, Copy)]
struct Bounds {
    min: [f32; 4],
    max: [f32; 4],
}

#[repr(C)]
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Pair {
    a: u32,
    b: u32,
}

#[repr(C)]
struct Pairs {
    pairs: *const Pair,
    count: usize,
}

#[repr(C)]
struct Scene {
    bodies: u32,
    frames: u32,
    world: Bounds,
    threads: u32,
    events: i32,
    parameters: *const f64,
}

#[repr(C)]
struct Frame {
    index: u32,
    bodies: u32,
    boxes: *const Bounds,
    changed: *const u32,
    changed_count: usize,
    collides: Option<extern "C" fn(*const c_void, u32, u32) -> i32>,
    filter: *const c_void,
}

#[repr(C)]
struct Answer {
    pairs: Pairs,
    ended: Pairs,
}

#[repr(C)]
struct Algorithm {
    id: *const c_char,
    family: *const c_char,
    summary: *const c_char,
    principle: *const c_char,
    time: *const c_char,
    space: *const c_char,
    source: *const c_char,
    traits: u32,
    max_bodies: u32,
    parameters: *const c_void,
    parameter_count: usize,
    margin: Option<extern "C" fn(*const f64) -> f32>,
    create: extern "C" fn(*const Scene, *const Frame) -> *mut Sweep,
    destroy: extern "C" fn(*mut Sweep),
    update_objects: extern "C" fn(*mut Sweep, *const Frame),
    clean_cache: Option<extern "C" fn(*mut Sweep)>,
    update_structures: Option<extern "C" fn(*mut Sweep)>,
    search_overlaps: extern "C" fn(*mut Sweep, *mut Answer) -> i32,
    draw: Option<extern "C" fn(*mut Sweep, *const c_void)>,
    error: Option<extern "C" fn(*mut Sweep) -> *const c_char>,
}

#[repr(C)]
pub struct Plugin {
    version: u32,
    algorithm_count: u32,
    algorithm_size: usize,
    algorithms: *const Algorithm,
}
unsafe impl Sync for Plugin {}
unsafe impl Sync for Algorithm {}

const INCREMENTAL: u32 = 2;
const EVENTS: u32 = 4;
const CHANGING_WORLDS: u32 = 8;

// The algorithm.

#[derive(Default)]
struct Sweep {
    events: bool,
    boxes: Vec<Bounds>,
    order: Vec<u32>,   // bodies, by their min; nearly sorted from frame to frame
    pairs: Vec<Pair>,  // of this frame, sorted
    before: Vec<Pair>, // of the frame before, sorted
    began: Vec<Pair>,
    ended: Vec<Pair>,
    collides: Option<extern "C" fn(*const c_void, u32, u32) -> i32>,
    filter: usize,
}

fn overlap(a: &Bounds, b: &Bounds) -> bool {
    (0..3).all(|axis| a.min[axis] <= b.max[axis] && b.min[axis] <= a.max[axis])
}

/// The entries of the sorted `a` that the sorted `b` lacks.
fn difference(a: &[Pair], b: &[Pair], result: &mut Vec<Pair>) {
    result.clear();
    result.extend(a.iter().filter(|pair| b.binary_search(pair).is_err()));
}

impl Sweep {
    fn update(&mut self, frame: &Frame) {
        let boxes = unsafe { slice(frame.boxes, frame.bodies as usize) };
        self.boxes.clear();
        self.boxes.extend_from_slice(boxes);
        self.collides = frame.collides;
        self.filter = frame.filter as usize;
    }

    fn search(&mut self) {
        if self.order.len() != self.boxes.len() {
            self.order = (0..self.boxes.len() as u32).collect();
        }
        let boxes = &self.boxes;
        self.order
            .sort_by(|&a, &b| boxes[a as usize].min[0].total_cmp(&boxes[b as usize].min[0]));
        std::mem::swap(&mut self.pairs, &mut self.before);
        self.pairs.clear();
        for (i, &first) in self.order.iter().enumerate() {
            let bounds = &boxes[first as usize];
            if bounds.min[0] > bounds.max[0] {
                continue; // absent
            }
            for &second in &self.order[i + 1..] {
                let other = &boxes[second as usize];
                if other.min[0] > bounds.max[0] {
                    break;
                }
                if overlap(bounds, other) && self.is_wanted(first, second) {
                    self.pairs.push(Pair { a: first.min(second), b: first.max(second) });
                }
            }
        }
        if self.events {
            self.pairs.sort_unstable();
            difference(&self.pairs, &self.before, &mut self.began);
            difference(&self.before, &self.pairs, &mut self.ended);
        }
    }

    fn is_wanted(&self, a: u32, b: u32) -> bool {
        self.collides.map_or(true, |collides| collides(self.filter as *const c_void, a, b) != 0)
    }
}

unsafe fn slice<'a, T>(data: *const T, count: usize) -> &'a [T] {
    if count == 0 { &[] } else { std::slice::from_raw_parts(data, count) }
}

fn view(pairs: &[Pair]) -> Pairs {
    Pairs { pairs: pairs.as_ptr(), count: pairs.len() }
}

// The table's functions. A panic must not unwind into the program.

extern "C" fn create(scene: *const Scene, initial: *const Frame) -> *mut Sweep {
    catch_unwind(|| {
        let mut sweep = Sweep { events: unsafe { (*scene).events != 0 }, ..Default::default() };
        sweep.update(unsafe { &*initial });
        Box::into_raw(Box::new(sweep))
    })
    .unwrap_or(std::ptr::null_mut())
}

extern "C" fn destroy(sweep: *mut Sweep) {
    drop(unsafe { Box::from_raw(sweep) });
}

extern "C" fn update_objects(sweep: *mut Sweep, frame: *const Frame) {
    unsafe { (*sweep).update(&*frame) }
}

extern "C" fn search_overlaps(sweep: *mut Sweep, answer: *mut Answer) -> i32 {
    let (sweep, answer) = unsafe { (&mut *sweep, &mut *answer) };
    if catch_unwind(AssertUnwindSafe(|| sweep.search())).is_err() {
        return 1;
    }
    answer.pairs = view(if sweep.events { &sweep.began } else { &sweep.pairs });
    answer.ended = view(&sweep.ended);
    0
}

static ALGORITHM: Algorithm = Algorithm {
    id: b"rust-sweep\0".as_ptr().cast(),
    family: b"Rust sweep\0".as_ptr().cast(),
    summary: b"sort and sweep along one axis, written in Rust\0".as_ptr().cast(),
    principle: b"sorting\0".as_ptr().cast(),
    time: b"O(n log n + w), w pairs that overlap on the axis\0".as_ptr().cast(),
    space: b"O(n + k)\0".as_ptr().cast(),
    source: b"Ericson 2005, 7.5\0".as_ptr().cast(),
    traits: INCREMENTAL | EVENTS | CHANGING_WORLDS,
    max_bodies: 0,
    parameters: std::ptr::null(),
    parameter_count: 0,
    margin: None,
    create,
    destroy,
    update_objects,
    clean_cache: None,
    update_structures: None,
    search_overlaps,
    draw: None,
    error: None,
};

static PLUGIN: Plugin = Plugin {
    version: 1,
    algorithm_count: 1,
    algorithm_size: std::mem::size_of::<Algorithm>(),
    algorithms: &ALGORITHM,
};

#[no_mangle]
pub extern "C" fn broadmark_c_plugin() -> *const Plugin {
    &PLUGIN
}
