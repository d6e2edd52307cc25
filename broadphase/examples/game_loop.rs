//! Balls in a box, by the C interface: rustc -O game_loop.rs, with -L if the library is elsewhere.

use std::ffi::CStr;
use std::os::raw::{c_char, c_int, c_void};

#[repr(C)]
struct Boxes {
    min: *const f32,
    max: *const f32,
    count: usize,
    stride: usize, // bytes from a body to the next one
}

#[repr(C)]
#[derive(Clone, Copy, Debug)]
struct Pair {
    a: u32,
    b: u32,
}

#[repr(C)]
struct Pairs {
    pairs: *const Pair,
    count: usize,
}

#[link(name = "broadmark-broadphase")]
extern "C" {
    fn bm_last_error() -> *const c_char;
    fn bm_create(options: *const c_void, created: *mut *mut c_void) -> c_int;
    fn bm_destroy(broadphase: *mut c_void);
    fn bm_update(broadphase: *mut c_void, boxes: Boxes) -> c_int;
    fn bm_get_pairs(broadphase: *const c_void, pairs: *mut Pairs) -> c_int;
}

fn check(status: c_int) -> Result<(), String> {
    match status {
        0 => Ok(()),
        _ => Err(unsafe { CStr::from_ptr(bm_last_error()) }.to_string_lossy().into_owned()),
    }
}

/// Owns an object of the library. Pairs are borrowed: the next update needs it exclusively.
struct BroadPhase(*mut c_void);

impl BroadPhase {
    fn new() -> Result<Self, String> {
        let mut created = std::ptr::null_mut();
        check(unsafe { bm_create(std::ptr::null(), &mut created) })?;
        Ok(Self(created))
    }

    fn update(&mut self, balls: &[Ball]) -> Result<(), String> {
        let first = balls.as_ptr();
        // The library takes boxes where the game has them.
        let boxes = unsafe {
            Boxes {
                min: std::ptr::addr_of!((*first).min).cast(),
                max: std::ptr::addr_of!((*first).max).cast(),
                count: balls.len(),
                stride: std::mem::size_of::<Ball>(),
            }
        };
        check(unsafe { bm_update(self.0, boxes) })
    }

    fn pairs(&self) -> Result<&[Pair], String> {
        let mut found = Pairs { pairs: std::ptr::null(), count: 0 };
        check(unsafe { bm_get_pairs(self.0, &mut found) })?;
        Ok(match found.count {
            0 => &[],
            count => unsafe { std::slice::from_raw_parts(found.pairs, count) },
        })
    }
}

impl Drop for BroadPhase {
    fn drop(&mut self) {
        unsafe { bm_destroy(self.0) }
    }
}

#[derive(Clone, Default)]
struct Ball {
    position: [f32; 3],
    velocity: [f32; 3],
    min: [f32; 3],
    max: [f32; 3],
}

impl Ball {
    fn step(&mut self) {
        for axis in 0..3 {
            self.position[axis] += self.velocity[axis];
            if !(0.0..=20.0).contains(&self.position[axis]) {
                self.velocity[axis] = -self.velocity[axis];
            }
            self.min[axis] = self.position[axis] - 0.5;
            self.max[axis] = self.position[axis] + 0.5;
        }
    }
}

fn main() -> Result<(), String> {
    let mut random = 1_u32;
    let mut number = move || {
        random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (random >> 8) as f32 / 16_777_216.0
    };
    let mut balls = vec![Ball::default(); 500];
    for ball in &mut balls {
        ball.position = std::array::from_fn(|_| 20.0 * number());
        ball.velocity = std::array::from_fn(|_| number() - 0.5);
    }

    let mut broad_phase = BroadPhase::new()?;
    let mut touched = 0;
    for _ in 0..100 {
        balls.iter_mut().for_each(Ball::step);
        broad_phase.update(&balls)?;
        touched += broad_phase.pairs()?.len();
    }
    println!("100 frames: {touched} pairs, the last one {:?}", broad_phase.pairs()?.last());

    balls[7].min[1] = f32::NAN;
    match broad_phase.update(&balls) {
        Err(error) => println!("an error: {error}"),
        Ok(()) => return Err("NaN was taken".into()),
    }
    Ok(())
}
