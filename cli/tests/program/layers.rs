//! Files of layers: what they hold, and what is refused.

use crate::folder::{Folder, text};
use exr::prelude::{ReadChannels, ReadLayers, read};
use std::fs;

const SMALL: &str = "quad.obj -q --size 24x16 -f nearest";

fn npy<T: npyz::Deserialize>(folder: &Folder, name: &str) -> (Vec<u64>, Vec<T>) {
    let bytes = fs::read(folder.path(name)).unwrap();
    let file = npyz::NpyFile::new(&bytes[..]).unwrap();
    (file.shape().to_vec(), file.into_vec().unwrap())
}

/// A channel of an EXR file as floats.
fn channel(folder: &Folder, file: &str, name: &str) -> Vec<f32> {
    let image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .first_valid_layer()
        .all_attributes()
        .from_file(folder.path(file))
        .unwrap();
    let channels = image.layer_data.channel_data.list;
    let found = channels.iter().find(|channel| channel.name.to_string() == name);
    found.unwrap_or_else(|| panic!("no {name}")).sample_data.values_as_f32().collect()
}

#[test]
fn every_format_holds_the_same_numbers() {
    let folder = Folder::new();
    folder.succeeds(&format!(
        "{SMALL} --layer all=all.exr --layer depth=depth.npy --layer normal=normal.npy \
         --layer object=object.npy --layer object=object.png --layer normal=normal.png \
         --layer albedo=albedo.png --layer-names names.json"
    ));
    // Layers alone: no picture.
    assert!(!folder.path("basrelief.png").exists());
    let (shape, depths) = npy::<f32>(&folder, "depth.npy");
    assert_eq!(shape, [16, 24]);
    assert!(depths[0] == f32::INFINITY && depths[8 * 24 + 12].is_finite());
    assert_eq!(channel(&folder, "all.exr", "depth.Z"), depths);
    let (shape, normals) = npy::<f32>(&folder, "normal.npy");
    assert_eq!(shape, [16, 24, 3]);
    let z: Vec<f32> = normals.iter().skip(2).step_by(3).copied().collect();
    assert_eq!(channel(&folder, "all.exr", "normal.Z"), z);
    let (_, objects) = npy::<u32>(&folder, "object.npy");
    assert_eq!((objects[0], objects[8 * 24 + 12]), (u32::MAX, 0));
    let picture = image::open(folder.path("object.png")).unwrap().into_luma16();
    assert_eq!((picture.as_raw()[0], picture.as_raw()[8 * 24 + 12]), (u16::MAX, 0));
    // The quad faces the eye, and its z.
    let picture = image::open(folder.path("normal.png")).unwrap().into_rgb16();
    assert_eq!(picture.get_pixel(0, 0).0, [0; 3]);
    assert_eq!(picture.get_pixel(12, 8).0, [32768, 32768, 65535]);
    let names: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path("names.json")).unwrap()).unwrap();
    assert_eq!(names["objects"][0]["triangles"], 2);
    assert_eq!(names["objects"][0]["material"], 0);
}

#[test]
fn regions_shards_and_pictures_change_no_layer() {
    let folder = Folder::new();
    folder.succeeds(&format!("{SMALL} --turntable 3 -o p#.png --layer depth=whole#.npy"));
    for i in 1..=3 {
        folder.succeeds(&format!("{SMALL} --turntable 3 --layer depth=s#.npy --shard {i}/3"));
        assert!(folder.path(&format!("p{i}.png")).exists());
        let [whole, shard] =
            ["whole", "s"].map(|name| fs::read(folder.path(&format!("{name}{i}.npy"))).unwrap());
        assert!(whole == shard, "frame {i}");
    }
    folder.succeeds(&format!("{SMALL} --region 5,3,10,7 --layer depth=part.npy"));
    let (shape, part) = npy::<f32>(&folder, "part.npy");
    let (_, whole) = npy::<f32>(&folder, "whole1.npy");
    assert_eq!(shape, [7, 10]);
    for y in 0..7 {
        assert_eq!(part[y * 10..][..10], whole[(y + 3) * 24 + 5..][..10]);
    }
    // Frames that are there are left alone.
    fs::write(folder.path("s2.npy"), "kept").unwrap();
    folder.succeeds(&format!("{SMALL} --turntable 3 --layer depth=s#.npy --skip-existing"));
    assert_eq!(fs::read(folder.path("s2.npy")).unwrap(), b"kept");
}

#[test]
fn layers_that_cannot_be_written_are_refused_before_the_work() {
    let folder = Folder::new();
    let before = folder.contents();
    for (options, reason) in [
        ("--layer far=a.exr", "is no layer"),
        ("--layer depth=a.png", "no range"),
        ("--layer depth=a.tif", "must end in"),
        ("--layer depth=a.npy --layer uv=a.npy", "twice"),
        ("--layer object=a.png -o a.png", "another file already"),
        ("--layer depth=missing/a.npy", "folder does not exist"),
        ("--layer depth=a.npy --turntable 2", "####"),
        ("--layer depth=a.npy --repeat 2", "needs a picture"),
        ("--layer depth=a.npy --view depth", "cannot be used with"),
        ("--layer-names a.json", "--layer"),
    ] {
        let output = folder.run(&format!("{SMALL} {options}"));
        let line = text(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{options}: {line}");
        assert!(line.contains(reason), "{options}: {line}");
    }
    assert_eq!(folder.contents(), before);
}
