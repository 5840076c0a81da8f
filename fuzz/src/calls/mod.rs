//! Every C function, in any order, with arguments that the header allows: pointers are null or valid, and counts and sizes
//! true; all else may be wrong.

mod depth;
mod given;
mod hang;

use crate::draw::Draw;
use crate::memory::Block;
use given::{Sized, reached};
use hangpose_ffi::*;
use std::ffi::{CStr, c_void};
use std::fmt::Write;
use std::ptr::{null, null_mut};

/// Most calls of a case.
const MOST_CALLS: usize = 24;
/// Most bytes for a call. One that needs more is given less, and must say so.
const MOST_BYTES: usize = 8 << 20;
/// Work limits of calls: a few milliseconds. Miri takes a thousand times as long.
const WORK: [u64; 5] = [WITH_THREADS, if cfg!(miri) { 200 } else { 20_000 }, 500, 10, 0];
/// The work limit of calls that may use a second thread.
const WITH_THREADS: u64 = if cfg!(miri) { 100 } else { 4_000 };

/// Stands for two threads: the second part is done before the first begins.
///
/// # Safety
///
/// The library gives functions with their arguments.
pub unsafe extern "C" fn second_first(
    _: *mut c_void,
    first: hangpose_task,
    first_argument: *mut c_void,
    second: hangpose_task,
    second_argument: *mut c_void,
) {
    // SAFETY: the library gives functions with their arguments.
    unsafe {
        second.expect("a function")(second_argument);
        first.expect("a function")(first_argument);
    }
}

/// A model, in memory of its own.
struct Model<T> {
    block: Block,
    handle: *mut T,
    /// Points of its cloud at most, or blocks of its volume.
    count: u32,
}

/// The state of a program that calls the library.
struct Program<'a> {
    draw: Draw<'a>,
    /// Alignment of all memory.
    offset: usize,
    params: hangpose_params,
    /// Not a part of the program, so that borrowing it does not borrow what the library holds.
    monitor: *mut hangpose_monitor,
    threads: *const hangpose_threads,
    objects: Vec<Model<hangpose_object>>,
    supporters: Vec<Model<hangpose_supporter>>,
    volumes: Vec<Model<hangpose_volume>>,
    /// A pose that was predicted.
    pose: hangpose_pose,
    /// What the library has answered.
    said: String,
}

/// Runs a program twice, in memory of another alignment: both times every answer is the same to the last bit.
pub fn run(data: &[u8]) {
    let answers = |offset| {
        let mut monitor = Sized::sized();
        let threads = hangpose_threads { join: Some(second_first), ..Sized::sized() };
        Program::new(data, offset, &mut monitor, &threads).run()
    };
    assert_eq!(answers(0), answers(5), "the answers are others when asked for again");
}

impl<'a> Program<'a> {
    fn new(
        data: &'a [u8],
        offset: usize,
        monitor: *mut hangpose_monitor,
        threads: *const hangpose_threads,
    ) -> Self {
        Self {
            draw: Draw::new(data),
            offset,
            params: Sized::sized(),
            monitor,
            threads,
            objects: Vec::new(),
            supporters: Vec::new(),
            volumes: Vec::new(),
            pose: Sized::sized(),
            said: String::new(),
        }
    }

    fn run(mut self) -> String {
        self.reset_params();
        for _ in 0..MOST_CALLS {
            if self.draw.is_done() {
                break;
            }
            match self.draw.below(24) {
                0..=3 => self.create_object(),
                4..=6 => self.create_supporter(),
                7 => self.update_supporter(),
                8..=10 => self.predict(),
                11 => self.predict_many(),
                12 => self.plan(),
                13 => self.reach(),
                14 => self.look_at_models(),
                15 => self.sample(),
                16 => self.create_volume(),
                17 => self.integrate(),
                18 => self.complete(),
                19 => self.find_surface(),
                20 => self.find_points(),
                21 => self.use_monitor(),
                22 => self.ask_for_words(),
                _ => self.reset_params(),
            }
            self.check_memory();
        }
        self.said
    }

    /// Makes a call with a detail, and checks what it says of the result.
    fn call(
        &mut self,
        name: &str,
        call: impl FnOnce(&mut Self, *mut hangpose_detail) -> hangpose_status,
    ) -> hangpose_status {
        let mut detail = hangpose_detail::sized();
        let kind = self.draw.below(16);
        if kind == 15 {
            detail.struct_size = detail.struct_size.wrapping_add(self.draw.word());
        }
        let is_readable = detail.struct_size as usize == size_of::<hangpose_detail>();
        let status = call(self, if kind == 14 { null_mut() } else { &mut detail });
        assert!((HANGPOSE_ERROR_SPARSE..=HANGPOSE_NO_PATH).contains(&status), "{name} returns {status}");
        if !is_readable {
            assert_eq!(status, HANGPOSE_ERROR_STRUCT_SIZE, "{name} took a detail of another header");
        } else if kind != 14 {
            assert_eq!(detail.status, status, "{name} returns {status}");
            let words = [text(&detail.field), text(&detail.message)];
            if status < 0 {
                assert!(!words[1].is_empty(), "{name} returns {status} and says nothing");
            }
            // How much memory is left depends on its alignment.
            if status != HANGPOSE_ERROR_MEMORY {
                write!(self.said, "{words:?} {} {} ", detail.index, detail.value).unwrap();
            }
        }
        writeln!(self.said, "{name} {status}").unwrap();
        status
    }

    /// Records numbers to the last bit.
    fn record<T: Sized>(&mut self, structs: &[T]) {
        // FNV-1a: the text would be megabytes.
        let hash = given::bytes(structs).iter().fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| {
            (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3)
        });
        write!(self.said, "{hash:x} ").unwrap();
    }

    /// Memory of as many bytes as a call needs; at times too little. Also whether it is enough.
    fn memory(&mut self, needed: usize) -> (Block, bool) {
        let less = if self.draw.one_in(12) { 1 + self.draw.below(needed.clamp(1, 60_000)) } else { 0 };
        let size = needed.saturating_sub(less).min(MOST_BYTES);
        (Block::new(size, self.offset), size >= needed)
    }

    /// The monitor of a call, with a limit for its work.
    fn monitor(&mut self) -> *mut hangpose_monitor {
        let limit = self.draw.pick(&WORK);
        if !self.draw.one_in(24) {
            self.init_monitor(limit);
        }
        // A monitor that was cancelled, or never initialised, is a case as well.
        self.monitor
    }

    fn init_monitor(&mut self, limit: u64) {
        let size = size_of::<hangpose_monitor>();
        // SAFETY: the pointer leads to a monitor that no call uses.
        let status = unsafe { hangpose_monitor_init(self.monitor, size, limit, null_mut()) };
        assert_eq!(status, HANGPOSE_OK);
        if limit == WITH_THREADS {
            // SAFETY: both stay where they are while the program runs.
            let status = unsafe { hangpose_monitor_use_threads(self.monitor, self.threads, null_mut()) };
            assert_eq!(status, HANGPOSE_OK);
        }
    }

    fn use_monitor(&mut self) {
        let mut size = size_of::<hangpose_monitor>();
        if self.draw.one_in(4) {
            size += self.draw.below(9);
        }
        let mut monitor = hangpose_monitor::sized();
        // SAFETY: the pointers lead to monitors, initialised or not, or are null.
        unsafe {
            hangpose_monitor_cancel(&mut monitor);
            assert_eq!(hangpose_monitor_is_cancelled(&monitor), 0);
            let limit = u64::from(self.draw.word());
            let status = self
                .call("monitor_init", |_, detail| hangpose_monitor_init(&mut monitor, size, limit, detail));
            hangpose_monitor_cancel(&mut monitor);
            assert_eq!(hangpose_monitor_is_cancelled(&monitor), u32::from(status == HANGPOSE_OK));
            let progress = hangpose_monitor_progress(self.monitor);
            assert!((0.0..=1.0).contains(&progress), "the progress is {progress}");
            if self.draw.one_in(8) {
                hangpose_monitor_cancel(self.monitor);
            }
            let case = self.draw.below(4);
            let wrong = if case == 2 { self.draw.below(9) as u32 } else { 0 };
            let given = *self.threads;
            let threads = hangpose_threads {
                struct_size: given.struct_size + wrong,
                join: given.join.filter(|_| case != 1),
                ..given
            };
            let at = if case == 0 { null() } else { &raw const threads };
            self.call("monitor_use_threads", |_, detail| {
                hangpose_monitor_use_threads(&mut monitor, at, detail)
            });
            hangpose_monitor_cancel(null_mut());
            assert_eq!((hangpose_monitor_is_cancelled(null()), hangpose_monitor_progress(null())), (0, 0.0));
        }
    }

    fn ask_for_words(&mut self) {
        let value = if self.draw.one_in(2) { self.draw.word() } else { self.draw.below(32) as u32 };
        // SAFETY: the functions return static strings, which is what is tested.
        let words = unsafe {
            [
                hangpose_status_string(value as i32),
                hangpose_status_string(-(self.draw.below(32) as i32)),
                hangpose_stage_string(value),
                hangpose_kind_string(value),
                hangpose_plan_reason_string(value),
                hangpose_version(),
            ]
            .map(|text| CStr::from_ptr(text).to_str().expect("English"))
        };
        assert!(words.iter().all(|text| !text.is_empty()));
        let is_known = value == hangpose_abi_version();
        assert_eq!(hangpose_check_abi(value) == HANGPOSE_OK, is_known);
        self.said += &words.concat();
    }

    /// Params of a profile for small models, at times with a wrong field.
    fn reset_params(&mut self) {
        let mut params = hangpose_params::sized();
        let size = size_of::<hangpose_params>() + if self.draw.one_in(24) { 4 } else { 0 };
        let profile =
            self.draw.pick(&[HANGPOSE_PROFILE_DEFAULT, HANGPOSE_PROFILE_DEFAULT, HANGPOSE_PROFILE_PAPER, 7]);
        let version = if self.draw.one_in(24) { self.draw.word() } else { HANGPOSE_ABI_VERSION };
        // SAFETY: the pointer leads to params.
        let status = self.call("params_init", |_, detail| unsafe {
            hangpose_params_init(&mut params, size, profile, version, detail)
        });
        if status != HANGPOSE_OK {
            return;
        }
        let draw = &mut self.draw;
        params.samples = 100 + draw.below(200) as u32;
        params.voxels = draw.pick(&[2000, 500, 50, 8000]);
        params.settle_attempts = draw.below(5) as u32;
        params.firm_enough = draw.below(3) as u32;
        (params.object_directions, params.rays_per_direction) =
            (1 + draw.below(8) as u32, 3 + draw.below(8) as u32);
        params.supporter_directions = 1 + draw.below(6) as u32;
        params.min_probability = draw.pick(&[0.3, 0.0]);
        given::spoil(&mut params, size_of::<hangpose_params>(), draw);
        // A search that is not limited otherwise would take minutes.
        if params.settle_attempts <= 10_000 {
            params.settle_attempts %= 8;
        }
        self.params = params;
    }

    /// Bytes for a call, by a query that is given limits.
    fn bytes_for(
        &mut self,
        limits: &hangpose_limits,
        query: unsafe extern "C" fn(*const hangpose_limits) -> usize,
    ) -> usize {
        // SAFETY: the pointers lead to limits or are null.
        unsafe {
            assert_eq!(query(null()), 0);
            let any = hangpose_limits {
                points: self.draw.word(),
                nodes: self.draw.word(),
                voxels: self.draw.word(),
                ..*limits
            };
            let more = hangpose_limits {
                points: any.points.saturating_add(1),
                nodes: any.nodes.saturating_add(1),
                voxels: any.voxels.saturating_add(1),
                ..any
            };
            assert!(query(&any) <= query(&more), "a size query wraps around");
            query(limits)
        }
    }

    /// The limits for the params and what they are used with.
    fn limits(
        &mut self,
        mesh: *const hangpose_mesh,
        cloud: *const hangpose_cloud,
    ) -> Option<hangpose_limits> {
        let mut limits = hangpose_limits::sized();
        if self.draw.one_in(32) {
            limits.struct_size = self.draw.word();
        }
        let params = self.params;
        // SAFETY: the pointers lead to structs or are null.
        let status = self.call("limits_of", |_, detail| unsafe {
            hangpose_limits_of(&params, mesh, cloud, &mut limits, detail)
        });
        (status == HANGPOSE_OK).then_some(limits)
    }

    fn check_memory(&self) {
        self.objects.iter().for_each(|model| model.block.check());
        self.supporters.iter().for_each(|model| model.block.check());
        self.volumes.iter().for_each(|model| model.block.check());
    }

    /// A model of a list: usually a valid one, at times null, a copy in another place, or memory without a model. The copy
    /// must live as long as the call.
    fn choose<T>(
        draw: &mut Draw,
        models: &[Model<T>],
        handle_bytes: usize,
        copy: &mut Vec<u64>,
    ) -> (*mut T, u32) {
        let kind = draw.below(16);
        let Some(model) = (!models.is_empty()).then(|| &models[draw.below(models.len())]) else {
            return (null_mut(), 0);
        };
        match kind {
            13 => (null_mut(), model.count),
            14 | 15 => {
                copy.resize(handle_bytes.div_ceil(8), 0);
                if kind == 15 {
                    // SAFETY: a handle is at least as long, and consists of bytes.
                    unsafe {
                        std::ptr::copy(model.handle.cast::<u8>(), copy.as_mut_ptr().cast(), handle_bytes)
                    };
                }
                (copy.as_mut_ptr().cast(), model.count)
            }
            _ => (model.handle, model.count),
        }
    }
}

/// A text of the library, which ends in its array.
fn text(chars: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = chars.iter().map(|c| *c as u8).collect();
    CStr::from_bytes_until_nul(&bytes).expect("a text ends").to_str().expect("a text is UTF-8").into()
}

/// Bytes that are copied of a handle that is moved: less than the smallest model's memory.
const HANDLE: usize = 256;

/// Asks about a pose of a path.
unsafe extern "C" fn accepts(
    context: *mut std::ffi::c_void,
    position: *const f32,
    quaternion: *const f32,
) -> i32 {
    // SAFETY: the header says that both lead to so many numbers, and the context is what was given.
    let (position, quaternion, beyond) =
        unsafe { (*position.cast::<[f32; 3]>(), *quaternion.cast::<[f32; 4]>(), *context.cast::<f32>()) };
    reached(&position, &quaternion);
    i32::from(position[0] <= beyond)
}
