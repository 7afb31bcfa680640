//! Saved states of an instance, and their bytes.

use std::ffi::c_void;

use super::{Handle, OK, Status, put, room, slice};
use crate::Instance;
use crate::instance::{Fault, Snapshot};

/// The saved state at `pointer`.
///
/// # Safety
/// It is null, or comes from here and has not been freed.
unsafe fn snapshot<'a>(pointer: *mut c_void) -> Result<&'a Snapshot, Fault> {
    // SAFETY: by the above.
    unsafe { pointer.cast::<Snapshot>().as_ref() }.ok_or_else(|| Fault::Saved("there is none".to_owned()))
}

/// Puts a saved state where the host wants it; one that is there is replaced, as the standard says.
///
/// # Safety
/// `place` is null or points to null or to a saved state.
unsafe fn keep(place: *mut *mut c_void, snapshot: Snapshot) {
    // SAFETY: by the above.
    unsafe {
        release(place);
        put(place, Box::into_raw(Box::new(snapshot)).cast());
    }
}

/// Frees the saved state at `place`, if there is one.
///
/// # Safety
/// As of [`keep`].
unsafe fn release(place: *mut *mut c_void) {
    // SAFETY: by the above.
    let Some(pointer) = (unsafe { place.as_mut() }) else { return };
    if !pointer.is_null() {
        // SAFETY: it comes from `Box::into_raw` and is used no more.
        drop(unsafe { Box::from_raw(pointer.cast::<Snapshot>()) });
        *pointer = std::ptr::null_mut();
    }
}

/// Saves the state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: *mut c_void, place: *mut *mut c_void) -> Status {
    let save = |own: &mut Instance| {
        if place.is_null() {
            return Err(Fault::Saved("there is no place for it".to_owned()));
        }
        // SAFETY: null, or null or a saved state there, as the standard says.
        unsafe { keep(place, own.save()) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, save) }
}

/// Restores a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: *mut c_void, saved: *mut c_void) -> Status {
    let restore = |own: &mut Instance| {
        // SAFETY: a saved state, as the standard says.
        own.restore(unsafe { snapshot(saved) }?)
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, restore) }
}

/// Frees a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(_instance: *mut c_void, place: *mut *mut c_void) -> Status {
    // SAFETY: null, or null or a saved state there, as the standard says.
    unsafe { release(place) };
    OK
}

/// The size of the bytes of a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: *mut c_void,
    saved: *mut c_void,
    size: *mut usize,
) -> Status {
    let measure = |own: &mut Instance| {
        // SAFETY: a saved state and room for one value, as the standard says.
        unsafe { put(size, own.serialize(snapshot(saved)?)?.len()) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, measure) }
}

/// The bytes of a saved state.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: *mut c_void,
    saved: *mut c_void,
    bytes: *mut u8,
    size: usize,
) -> Status {
    let serialize = |own: &mut Instance| {
        // SAFETY: a saved state and room of this size, as the standard says.
        let (text, room) = unsafe { (own.serialize(snapshot(saved)?)?, room(bytes, size)) };
        let (found, wanted) = (room.len(), text.len());
        let place = room.get_mut(..wanted).ok_or(Fault::Length { what: "the serialized state", found, wanted })?;
        place.copy_from_slice(&text);
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, serialize) }
}

/// The saved state of these bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: *mut c_void,
    bytes: *const u8,
    size: usize,
    place: *mut *mut c_void,
) -> Status {
    let deserialize = |own: &mut Instance| {
        if place.is_null() {
            return Err(Fault::Saved("there is no place for it".to_owned()));
        }
        // SAFETY: bytes of this size; null, or null or a saved state at `place`, as the standard says.
        unsafe { keep(place, own.deserialize(slice(bytes, size))?) };
        Ok(())
    };
    // SAFETY: an instance, as `Handle::call` says.
    unsafe { Handle::call(instance, deserialize) }
}
