//! Files in the published formats, written here.

use alloc::collections::BTreeMap;
use std::fs::{self, File};
use std::io::Write as _;
use std::path::{Path, PathBuf};

use flate2::Compression;
use flate2::write::{DeflateEncoder, GzEncoder};
use prost::Message as _;
use rawzip::{CompressionMethod, ZipArchiveWriter};

use super::{Classes, Suite, SuiteScene, read_whole};
use crate::format::{Example, Feature, Features, Floats, Strings, TfValues, masked_crc, write_atomic};

fn strings(value: Vec<Vec<u8>>) -> Feature {
    Feature { values: Some(TfValues::Strings(Strings { value })) }
}

fn floats(value: &[f32]) -> Feature {
    Feature { values: Some(TfValues::Floats(Floats { value: value.to_vec() })) }
}

/// One string per byte, as the files of `multi_object_datasets` have it.
fn single_bytes(bytes: &[u8]) -> Feature {
    strings(bytes.iter().map(|&byte| vec![byte]).collect())
}

fn example(features: impl IntoIterator<Item = (&'static str, Feature)>) -> Vec<u8> {
    let feature: BTreeMap<String, Feature> = features.into_iter().map(|(name, f)| (name.to_owned(), f)).collect();
    Example { features: Some(Features { feature }) }.encode_to_vec()
}

fn framed(record: &[u8]) -> Vec<u8> {
    let length = (record.len() as u64).to_le_bytes();
    let mut bytes = length.to_vec();
    bytes.extend(masked_crc(&length).to_le_bytes());
    bytes.extend(record);
    bytes.extend(masked_crc(record).to_le_bytes());
    bytes
}

fn gzipped(folder: &Path, records: &[Vec<u8>]) -> PathBuf {
    let path = folder.join("set.tfrecords");
    let mut file = GzEncoder::new(File::create(&path).unwrap(), Compression::default());
    records.iter().for_each(|record| file.write_all(&framed(record)).unwrap());
    file.finish().unwrap();
    path
}

/// A red square of 2 x 2 pixels in the upper left corner of a black picture; the second object is not there.
fn tetrominoes_record() -> Vec<u8> {
    let mut image = vec![0; 35 * 35 * 3];
    let mut masks = vec![0; 4 * 35 * 35];
    masks[..35 * 35].fill(255);
    for pixel in [0, 1, 35, 36] {
        image[3 * pixel] = 255;
        masks[pixel] = 0;
        // Masks stand one after the other; that of the third entity.
        masks[2 * 35 * 35 + pixel] = 255;
    }
    example([
        ("image", single_bytes(&image)),
        ("mask", single_bytes(&masks)),
        ("visibility", floats(&[1.0, 0.0, 1.0, 0.0])),
        ("shape", floats(&[0.0, 0.0, 7.0, 0.0])),
        ("x", floats(&[0.0; 4])),
    ])
}

#[test]
fn tetrominoes_are_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = gzipped(folder.path(), &[tetrominoes_record(), tetrominoes_record()]);
    let scenes = Suite::Tetrominoes.read(&path, 100).unwrap();
    assert_eq!(scenes.len(), 2);
    assert_eq!(Suite::Tetrominoes.read(&path, 1).unwrap().len(), 1);
    let SuiteScene { size, pixels, labels, whole, classes } = &scenes[1];
    assert_eq!((size.width(), size.height(), pixels.len()), (35, 35, 35 * 35 * 3));
    assert_eq!(pixels[..6], [255, 0, 0, 255, 0, 0]);
    let seen: Vec<usize> = (0..labels.len()).filter(|&pixel| labels[pixel] == 1).collect();
    assert_eq!(seen, [0, 1, 35, 36]);
    assert!(labels.iter().all(|&label| label <= 1) && whole.is_empty());
    assert_eq!(classes, &[7]);
}

#[test]
fn multi_dsprites_are_read() {
    let folder = tempfile::tempdir().unwrap();
    // All masks of a pixel stand together; 3 entities, one channel.
    let mut masks = vec![0; 64 * 64 * 3];
    masks[5 * 3 + 1] = 255;
    masks[9 * 3 + 2] = 255;
    let record = |image: Feature| {
        example([
            ("image", image),
            ("mask", strings(vec![masks.clone()])),
            ("visibility", floats(&[1.0, 1.0, 1.0])),
            ("shape", floats(&[0.0, 1.0, 3.0])),
        ])
    };
    let gray = vec![9; 64 * 64];
    let path = gzipped(folder.path(), &[record(single_bytes(&gray)), record(strings(vec![vec![8; 64 * 64 * 3]]))]);
    let scenes = Suite::MultiDsprites.read(&path, 2).unwrap();
    assert_eq!((scenes[0].labels[5], scenes[0].labels[9], scenes[0].labels[4]), (1, 2, 0));
    assert_eq!((scenes[0].pixels.len(), scenes[0].pixels[0], scenes[1].pixels[0]), (64 * 64 * 3, 9, 8));
    assert_eq!(scenes[1].classes, [1, 3]);
}

#[test]
fn files_that_are_not_gzipped_are_read_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("plain.tfrecords");
    fs::write(&path, framed(&tetrominoes_record())).unwrap();
    assert_eq!(Suite::Tetrominoes.read(&path, 3).unwrap().len(), 1);
}

#[test]
fn the_checksum_is_that_of_the_published_format() {
    // RFC 3720, B.4: 32 bytes of zeros have the CRC32C 0x8a9136aa; turned right by 15 bits and 0xa282ead8 added.
    assert_eq!(masked_crc(&[0; 32]), 0x8a91_36aa_u32.rotate_right(15).wrapping_add(0xa282_ead8));
}

#[test]
fn damaged_files_are_refused_with_the_record() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("set.tfrecords");
    let good = framed(&tetrominoes_record());
    let refused = |bytes: Vec<u8>, suite: Suite| {
        fs::write(&path, bytes).unwrap();
        suite.read(&path, 5).unwrap_err().to_string()
    };
    let with = |at: usize, change: u8| {
        let mut bytes = good.clone();
        bytes[at] ^= change;
        [good.clone(), bytes].concat()
    };
    for (bytes, part) in [
        (with(3, 1), "length that its checksum denies"),
        (with(200, 1), "another checksum"),
        (good[..good.len() - 2].to_vec(), "truncated"),
        (good[..5].to_vec(), "truncated"),
        (framed(b"\x0a\xff"), "holds no features"),
        (framed(&example([("visibility", floats(&[1.0])), ("shape", floats(&[1.0]))])), "'image'"),
        (framed(&example([("visibility", floats(&[1.0])), ("shape", floats(&[1.0, 2.0]))])), "'shape'"),
        (framed(&example([])), "'visibility'"),
    ] {
        let error = refused(bytes, Suite::Tetrominoes);
        assert!(
            error.contains(part) && error.contains("record ") && error.contains("set.tfrecords"),
            "{part}: {error}"
        );
    }
    let error = refused(good.clone(), Suite::MultiDsprites);
    assert!(error.contains("right --preset"), "{error}");
    let mut gzip = GzEncoder::new(Vec::new(), Compression::default());
    gzip.write_all(&good).unwrap();
    let mut gzip = gzip.finish().unwrap();
    gzip.truncate(gzip.len() / 2);
    assert!(refused(gzip, Suite::Tetrominoes).contains("record 1"));
}

/// A NumPy file of bytes.
fn npy(shape: &[usize], values: &[u8]) -> Vec<u8> {
    let shape: Vec<String> = shape.iter().map(|n| format!("{n}, ")).collect();
    let header = format!("{{'descr': '|u1', 'fortran_order': False, 'shape': ({}), }}\n", shape.concat());
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend(u16::try_from(header.len()).unwrap().to_le_bytes());
    bytes.extend(header.as_bytes());
    bytes.extend(values);
    bytes
}

/// As `numpy.savez` (stored) and `numpy.savez_compressed` write archives.
fn npz(folder: &Path, arrays: &[(&str, Vec<u8>)], method: CompressionMethod) -> PathBuf {
    let mut archive = ZipArchiveWriter::new(Vec::new());
    for (name, bytes) in arrays {
        let (mut entry, config) = archive.new_file(format!("{name}.npy")).compression_method(method).start().unwrap();
        let descriptor = if method == CompressionMethod::STORE {
            let mut writer = config.wrap(&mut entry);
            writer.write_all(bytes).unwrap();
            writer.finish().unwrap().1
        } else {
            let mut writer = config.wrap(DeflateEncoder::new(&mut entry, Compression::default()));
            writer.write_all(bytes).unwrap();
            let (encoder, descriptor) = writer.finish().unwrap();
            encoder.finish().unwrap();
            descriptor
        };
        entry.finish(descriptor).unwrap();
    }
    let path = folder.join("shapes.npz");
    fs::write(&path, archive.finish().unwrap()).unwrap();
    path
}

/// Two pictures of 2 x 3 pixels, gray: of two objects, and of one. Layers: two objects, the first in front, and the background.
fn csr_arrays() -> [(&'static str, Vec<u8>); 3] {
    let image = npy(&[2, 2, 3, 1], &[255, 255, 0, 0, 255, 255, 7, 7, 7, 7, 7, 7]);
    let segment = npy(&[2, 2, 3], &[0, 0, 2, 2, 1, 1, 2, 2, 2, 2, 2, 0]);
    let front = [9, 255, 9, 255, 9, 0, 9, 0, 9, 0, 9, 0];
    let behind = [9, 0, 9, 255, 9, 0, 9, 0, 9, 255, 9, 255];
    let ground = [9, 255].repeat(6);
    let one = [9, 0, 9, 0, 9, 0, 9, 0, 9, 0, 9, 255];
    let empty = [9, 0].repeat(6);
    let layers = [&front[..], &behind, &ground, &one, &empty, &ground].concat();
    [("image", image), ("segment", segment), ("layers", npy(&[2, 3, 2, 3, 2], &layers))]
}

#[test]
fn csr_archives_are_read_stored_and_deflated() {
    for method in [CompressionMethod::STORE, CompressionMethod::DEFLATE] {
        let folder = tempfile::tempdir().unwrap();
        let path = npz(folder.path(), &csr_arrays(), method);
        let scenes = Suite::Csr.read(&path, 10).unwrap();
        assert_eq!(scenes.len(), 2);
        // Painted from behind: the second layer is object 1, the first one object 2.
        assert_eq!(scenes[0].labels, [2, 2, 0, 0, 1, 1]);
        assert_eq!(scenes[0].whole, [0, 255, 0, 0, 255, 255, 255, 255, 0, 0, 0, 0]);
        assert_eq!(scenes[0].pixels[..4], [255, 255, 255, 255]);
        assert_eq!((&scenes[1].labels[..], scenes[1].whole.len()), (&[0, 0, 0, 0, 0, 1][..], 6));
    }
}

#[test]
fn arrays_that_do_not_fit_are_refused_by_name() {
    let folder = tempfile::tempdir().unwrap();
    let refused = |at: usize, name: &'static str, bytes: Vec<u8>| {
        let mut arrays = csr_arrays();
        arrays[at] = (name, bytes);
        let path = npz(folder.path(), &arrays, CompressionMethod::DEFLATE);
        Suite::Csr.read(&path, 10).unwrap_err().to_string()
    };
    let float = String::from_utf8_lossy(&npy(&[1], &[0])).replace("|u1", "<f4").into_bytes();
    for (error, parts) in [
        (refused(1, "segments", npy(&[1], &[0])), ["array 'segment'", "is missing"]),
        (refused(0, "image", npy(&[2, 2, 3], &[0; 12])), ["array 'image'", "number x height x width x 3"]),
        (refused(1, "segment", npy(&[2, 3, 2], &[0; 12])), ["array 'segment'", "must be 2 x 2 x 3"]),
        (refused(2, "layers", npy(&[1, 1, 2, 3, 1], &[0; 6])), ["array 'layers'", "those of the images"]),
        (refused(0, "image", npy(&[2, 2, 3, 1], &[0; 11])), ["image", "truncated"]),
        (refused(0, "image", b"P5 2 2".to_vec()), ["image", "cannot be read"]),
    ] {
        assert!(parts.iter().all(|part| error.contains(part)) && error.contains("shapes.npz"), "{error}");
    }
    assert!(refused(0, "image", float.clone()).contains("image"), "{float:?}");
    let path = folder.path().join("shapes.npz");
    fs::write(&path, b"no archive").unwrap();
    assert!(Suite::Csr.read(&path, 1).unwrap_err().to_string().contains("no readable .npz"));
}

#[test]
fn whole_objects_come_back_from_their_file() {
    let folder = tempfile::tempdir().unwrap();
    let path = npz(folder.path(), &csr_arrays(), CompressionMethod::STORE);
    let scene = &Suite::Csr.read(&path, 1).unwrap()[0];
    let picture = folder.path().join("00000.png");
    for (ending, bytes) in scene.files().unwrap() {
        write_atomic(&picture.with_extension(ending), &bytes).unwrap();
    }
    let whole = read_whole(&picture, scene.size, 100).unwrap().unwrap();
    let expected: Vec<bool> = scene.whole.iter().map(|&value| value > 127).collect();
    assert_eq!(whole, expected);
    fs::copy(&picture, picture.with_extension("whole.png")).unwrap();
    let other = dvp_core::ImageSize::new(2, 2).unwrap();
    assert!(read_whole(&picture, other, 100).unwrap_err().to_string().contains("tiles"));
    assert_eq!(read_whole(&folder.path().join("00001.png"), scene.size, 100).unwrap(), None);
}

#[test]
fn classes_come_back_and_others_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    assert_eq!(Classes::read(folder.path()).unwrap(), None);
    let classes = Classes::new(BTreeMap::from([("00000".to_owned(), vec![3, 1])]));
    let path = folder.path().join("classes.json");
    fs::write(&path, classes.to_json().unwrap()).unwrap();
    assert_eq!(Classes::read(folder.path()).unwrap(), Some(classes));
    for (text, part) in [("{", "classes of objects"), ("{\"version\":9,\"objects\":{}}", "version 9")] {
        fs::write(&path, text).unwrap();
        let error = Classes::read(folder.path()).unwrap_err().to_string();
        assert!(error.contains(part), "{error}");
    }
}
