use crate::failure::{Failure, Reason};
use core::ffi::{CStr, c_char};

/// Version of the structs and functions in this header. hangpose_params_init and hangpose_check_abi refuse a
/// program whose header has another version than the library.
pub const HANGPOSE_ABI_VERSION: u32 = 3;

const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");

/// Returns the HANGPOSE_ABI_VERSION with which the library was built.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_abi_version() -> u32 {
    HANGPOSE_ABI_VERSION
}

/// Returns HANGPOSE_OK if `abi_version` is the version of the library, else HANGPOSE_ERROR_ABI_VERSION. Pass
/// HANGPOSE_ABI_VERSION.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_check_abi(abi_version: u32) -> crate::hangpose_status {
    check(abi_version).err().map_or(crate::HANGPOSE_OK, |failure| failure.status())
}

/// Returns the version of the library, for example "0.1.0"; a static string, never null.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_version() -> *const c_char {
    const TEXT: &CStr = match CStr::from_bytes_with_nul(VERSION.as_bytes()) {
        Ok(text) => text,
        Err(_) => panic!("a version has no NUL inside"),
    };
    TEXT.as_ptr()
}

pub(crate) fn check(abi_version: u32) -> Result<(), Failure> {
    if abi_version == HANGPOSE_ABI_VERSION { Ok(()) } else { Err(Failure::Version { given: abi_version }) }
}
