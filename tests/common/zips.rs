//! Writes zip archives.

/// How an entry is packed.
#[derive(Clone, Copy, PartialEq)]
pub enum Packing {
    Stored,
    Deflated,
}

/// A zip archive with these files.
pub fn zip(files: &[(&str, &[u8])], packing: Packing) -> Vec<u8> {
    let (mut archive, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let (method, packed) = match packing {
            Packing::Stored => (0_u16, content.to_vec()),
            Packing::Deflated => (8, miniz_oxide::deflate::compress_to_vec(content, 6)),
        };
        let mut about = Vec::new();
        about.extend([20_u16, 0, method, 0, 0].map(u16::to_le_bytes).concat());
        let sizes = [checksum(content), packed.len() as u32, content.len() as u32];
        about.extend(sizes.map(u32::to_le_bytes).concat());
        about.extend([name.len() as u16, 0].map(u16::to_le_bytes).concat());
        let at = archive.len() as u32;
        archive.extend([b"PK\x03\x04", &about[..], name.as_bytes(), &packed].concat());
        directory.extend(
            [
                b"PK\x01\x02\x14\x00",
                &about[..],
                &[0; 10],
                &at.to_le_bytes(),
            ]
            .concat(),
        );
        directory.extend(name.as_bytes());
    }
    let count = files.len() as u16;
    let mut end = [0, 0, count, count].map(u16::to_le_bytes).concat();
    end.extend(
        [directory.len() as u32, archive.len() as u32]
            .map(u32::to_le_bytes)
            .concat(),
    );
    end.extend([0; 2]);
    [&archive[..], &directory, b"PK\x05\x06", &end].concat()
}

/// The CRC-32 of some bytes, by its definition: the remainder of a division of polynomials.
fn checksum(bytes: &[u8]) -> u32 {
    let bits = bytes
        .iter()
        .flat_map(|byte| (0..8).map(move |k| byte >> k & 1));
    let mut remainder = u32::MAX;
    for bit in bits {
        let carry = (remainder & 1) != u32::from(bit);
        remainder >>= 1;
        if carry {
            remainder ^= 0xedb8_8320;
        }
    }
    !remainder
}
