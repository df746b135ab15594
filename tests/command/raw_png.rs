//! PNG files of the kinds that our encoder never writes: palettes, few bits per pixel, interlaced.

/// A kind of PNG.
pub(crate) struct RawPng<'a> {
    /// Columns and rows.
    pub(crate) size: [u32; 2],
    /// Bits per sample.
    pub(crate) depth: u8,
    /// 0 gray, 2 RGB, 3 palette, 4 gray with alpha, 6 RGBA.
    pub(crate) kind: u8,
    /// Whether rows and columns come in the seven passes of Adam7.
    pub(crate) interlaced: bool,
    /// Chunks between header and pixels: palette, transparency.
    pub(crate) chunks: &'a [(&'a [u8; 4], &'a [u8])],
}

/// First column and row, and steps between columns and rows, of the passes of Adam7.
const PASSES: [[u32; 4]; 7] =
    [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

impl RawPng<'_> {
    /// The bytes of the file; `samples` are those of the pixel in column x and row y, high bits first.
    pub(crate) fn encode<const N: usize>(&self, samples: impl Fn(u32, u32) -> [u16; N]) -> Vec<u8> {
        let [width, height] = self.size;
        let whole = [[0, 0, 1, 1]];
        let passes = if self.interlaced { &PASSES[..] } else { &whole[..] };
        let mut lines = Vec::new();
        for &[left, top, across, down] in passes {
            for y in (top..height).step_by(down.try_into().unwrap()) {
                let row = (left..width).step_by(across.try_into().unwrap()).flat_map(|x| samples(x, y));
                let bits: Vec<u8> = row
                    .flat_map(|value| (0..self.depth).rev().map(move |bit| u8::from(value >> bit & 1 == 1)))
                    .collect();
                // No filter.
                lines.push(0);
                lines.extend(bits.chunks(8).map(|byte| (0..8).fold(0, |sum, i| sum << 1 | byte.get(i).unwrap_or(&0))));
            }
        }
        let mut header = [width.to_be_bytes(), height.to_be_bytes()].concat();
        header.extend([self.depth, self.kind, 0, 0, u8::from(self.interlaced)]);
        let mut file = b"\x89PNG\r\n\x1a\n".to_vec();
        push(&mut file, b"IHDR", &header);
        self.chunks.iter().for_each(|(name, data)| push(&mut file, name, data));
        push(&mut file, b"IDAT", &stored(&lines));
        push(&mut file, b"IEND", &[]);
        file
    }
}

fn push(file: &mut Vec<u8>, name: &[u8; 4], data: &[u8]) {
    file.extend(u32::try_from(data.len()).unwrap().to_be_bytes());
    let named = [name, data].concat();
    let mut crc = u32::MAX;
    for byte in &named {
        crc ^= u32::from(*byte);
        for _ in 0..8 {
            crc = crc >> 1 ^ if crc & 1 == 1 { 0xedb8_8320 } else { 0 };
        }
    }
    file.extend(named);
    file.extend((!crc).to_be_bytes());
}

/// A zlib stream of one block without compression.
fn stored(data: &[u8]) -> Vec<u8> {
    let len = u16::try_from(data.len()).unwrap();
    let mut stream = vec![0x78, 0x01, 0x01];
    stream.extend([len.to_le_bytes(), (!len).to_le_bytes()].concat());
    stream.extend(data);
    let (mut a, mut b) = (1_u32, 0_u32);
    for &byte in data {
        a = (a + u32::from(byte)) % 65_521;
        b = (b + a) % 65_521;
    }
    stream.extend((b << 16 | a).to_be_bytes());
    stream
}
