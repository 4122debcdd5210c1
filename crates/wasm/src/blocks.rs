//! Blocks of memory that the host of the module reads and writes.

use crate::Engine;

/// Bytes of the length of a text.
const HEADER: usize = 4;

/// Blocks by their addresses, and the engine that answers the requests in them. An address that is not that of a block is ignored, so no call of the host
/// reads or frees memory that is in use.
#[derive(Debug)]
pub(crate) struct Blocks {
    blocks: Vec<Box<[u8]>>,
    engine: Engine,
}

impl Blocks {
    pub(crate) const fn new() -> Self {
        Self {
            blocks: Vec::new(),
            engine: Engine::new(),
        }
    }

    /// Makes a block for `length` bytes. Returns its address, or 0 if there is not so much memory.
    pub(crate) fn reserve(&mut self, length: u32) -> usize {
        let mut block = Vec::new();
        let bytes = HEADER.saturating_add(length as usize);
        if block.try_reserve_exact(bytes).is_err() {
            return 0;
        }
        block.extend(length.to_le_bytes());
        block.resize(bytes, 0);
        self.push(block)
    }

    fn push(&mut self, block: Vec<u8>) -> usize {
        let block = block.into_boxed_slice();
        let address = block.as_ptr().addr();
        self.blocks.push(block);
        address
    }

    /// Removes a block.
    pub(crate) fn release(&mut self, address: usize) -> Option<Box<[u8]>> {
        let mut blocks = self.blocks.iter();
        let place = blocks.position(|block| block.as_ptr().addr() == address)?;
        Some(self.blocks.swap_remove(place))
    }

    /// Answers the request in a block. Returns the address of the block of the response.
    pub(crate) fn call(&mut self, address: usize) -> usize {
        let block = self.release(address).unwrap_or_default();
        let request = block.get(HEADER..).unwrap_or_default();
        let response = self.engine.respond(&String::from_utf8_lossy(request));
        let mut block = Vec::with_capacity(HEADER + response.len());
        block.extend((response.len() as u32).to_le_bytes());
        block.extend(response.as_bytes());
        self.push(block)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::respond;

    /// Returns the text of a block, as a host reads it.
    fn text(blocks: &mut Blocks, address: usize) -> String {
        let block = blocks.release(address).expect("a block");
        let (header, text) = block.split_at(HEADER);
        let length = u32::from_le_bytes(header.try_into().expect("four bytes"));
        assert_eq!(length as usize, text.len());
        String::from_utf8(text.to_vec()).expect("a text")
    }

    /// Makes a block with a request, as a host writes it.
    fn request(blocks: &mut Blocks, text: &[u8]) -> usize {
        let address = blocks.reserve(text.len() as u32);
        let block = blocks.blocks.last_mut().expect("the block");
        block[HEADER..].copy_from_slice(text);
        address
    }

    #[test]
    fn a_request_becomes_a_response_and_its_block_is_released() {
        let mut blocks = Blocks::new();
        let asked = br#"{"mesh": {"shape": {"name": "cube"}}, "ask": "facts"}"#;
        let asked_at = request(&mut blocks, asked);
        let other_at = request(&mut blocks, b"\xff");
        let answered_at = blocks.call(asked_at);
        assert_eq!(blocks.blocks.len(), 2);
        let expected = respond(str::from_utf8(asked).expect("a text"));
        assert_eq!(text(&mut blocks, answered_at), expected);
        let answered_at = blocks.call(other_at);
        assert!(text(&mut blocks, answered_at).starts_with(r#"{"error":"#));
        assert_eq!(blocks.blocks.len(), 0);
    }

    #[test]
    fn an_address_without_a_block_is_an_empty_request() {
        let mut blocks = Blocks::new();
        assert_eq!(blocks.release(8), None);
        let answered_at = blocks.call(8);
        assert!(text(&mut blocks, answered_at).starts_with(r#"{"error":"#));
    }
}
