//! The explanations of Sixfold as a WebAssembly module without imports.
//!
//! The module exports its memory and three functions. A block is a text in this memory: at its address are
//! four bytes with the length of the text (the lowest byte first), and then the text as UTF-8.
//!
//! | function | what it does |
//! |---|---|
//! | `reserve(length) -> address` | makes a block for a request of `length` bytes; 0 if there is not so much memory |
//! | `call(address) -> address` | answers the request in a block, releases this block, and returns the block of the response |
//! | `release(address)` | releases the block of a response |
//!
//! [`respond`] describes requests and responses. The module has one [`Engine`], so a request can name the
//! mesh of an earlier one as `"last"`. In JavaScript:
//!
//! ```js
//! const { instance } = await WebAssembly.instantiate(bytes, {});
//! const { memory, reserve, call, release } = instance.exports;
//! function respond(request) {
//!   const text = new TextEncoder().encode(JSON.stringify(request));
//!   const asked = reserve(text.length);
//!   if (asked === 0) throw new Error("the request is too large");
//!   new Uint8Array(memory.buffer, asked + 4, text.length).set(text);
//!   const answered = call(asked);
//!   const length = new DataView(memory.buffer).getUint32(answered, true);
//!   const response = new TextDecoder().decode(new Uint8Array(memory.buffer, answered + 4, length));
//!   release(answered);
//!   return JSON.parse(response);
//! }
//! ```

// Only the module has a host.
#[cfg(any(test, target_family = "wasm"))]
mod blocks;
#[cfg(target_family = "wasm")]
mod exports;

pub use sixfold_explain::{Engine, respond};
