use crate::failure::Failure;
use core::ffi::{CStr, c_char};

/// Version of the structs and functions in this header; another one than the library's is refused at run time, by
/// hangpose_params_init and hangpose_check_abi.
pub const HANGPOSE_ABI_VERSION: u32 = 1;

const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "\0");

/// The HANGPOSE_ABI_VERSION that the library was built with.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_abi_version() -> u32 {
    HANGPOSE_ABI_VERSION
}

/// HANGPOSE_OK if `abi_version`, for which the caller gives HANGPOSE_ABI_VERSION, is the library's, or else
/// HANGPOSE_ERROR_ABI_VERSION.
#[unsafe(no_mangle)]
pub extern "C" fn hangpose_check_abi(abi_version: u32) -> crate::hangpose_status {
    check(abi_version).err().map_or(crate::HANGPOSE_OK, |failure| failure.status())
}

/// The library's version, for example "0.1.0".
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
