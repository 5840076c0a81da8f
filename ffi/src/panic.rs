//! The panic handler. No panic is expected, because all arguments are checked before they reach the core.

/// Stops the program at the panic, as a failed assertion in C does, so that a debugger or a core dump shows the
/// place. A program without an operating system has no `abort`, so this uses the trap instruction of the processor.
#[panic_handler]
fn stop(info: &core::panic::PanicInfo) -> ! {
    // embedded/no_panic.sh reads in the program where it may panic. Otherwise the compiler drops the places, as nothing uses them.
    if cfg!(panic_places) {
        core::hint::black_box(info.location());
    }
    // SAFETY: the instructions raise an exception and touch nothing.
    #[allow(unused_unsafe)]
    unsafe {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        core::arch::asm!("ud2", options(nomem, nostack));
        #[cfg(target_arch = "aarch64")]
        core::arch::asm!("brk #1", options(nomem, nostack));
        #[cfg(target_arch = "arm")]
        core::arch::asm!("udf #0", options(nomem, nostack));
        #[cfg(any(target_arch = "riscv32", target_arch = "riscv64"))]
        core::arch::asm!("unimp", options(nomem, nostack));
    }
    loop {
        core::hint::spin_loop();
    }
}
