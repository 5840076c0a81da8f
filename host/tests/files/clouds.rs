//! Readers of each cloud format.

use crate::samples::*;

const SEEN: [[f32; 3]; 3] = [[1.0, 2.0, 0.0], [3.0, 4.0, 0.0], [5.0, 6.0, 0.0]];

#[test]
fn pcd_leaves_out_missing_points_in_every_encoding() {
    for content in [pcd_text().into_bytes(), pcd_binary(), pcd_compressed()] {
        let cloud = cloud("scan.pcd", content).unwrap();
        assert_eq!(cloud.points, SEEN);
        assert_eq!(cloud.normals, None);
        assert_eq!(cloud.notes, ["1 of 4 points were missing (NaN) and were dropped."]);
    }
}

#[test]
fn pcd_finds_its_fields_by_name() {
    let header = pcd_header("x y z", 2, "ascii")
        .replace("FIELDS x y z", "FIELDS normal_y _ rgb z y x normal_z normal_x label")
        .replace("SIZE 4 4 4", "SIZE 4 1 4 8 8 8 4 4 2")
        .replace("TYPE F F F", "TYPE F U U F F F F F U")
        .replace("COUNT 1 1 1", "COUNT 1 3 1 1 1 1 1 1 1")
        .replace("VIEWPOINT 0 0 0", "VIEWPOINT 0 0 1");
    let cloud =
        cloud("scan.pcd", header + "0 9 9 9 255 3 2 1 1 0 7\nnan 9 9 9 255 6 5 4 nan nan 7\n").unwrap();
    assert_eq!(cloud.points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
    assert_eq!(cloud.normals, Some(vec![[0.0, 0.0, 1.0], [0.0; 3]]));
    assert_eq!(cloud.viewpoints, [[0.0, 0.0, 1.0]]);
    assert_eq!(cloud.notes, ["1 of 2 normals are zero."]);
}

#[test]
fn coordinates_of_a_map_keep_their_details() {
    let text = "500000.125 5400000.5 300.0625\n500000.25 5400000.5 300.0625\n500000.125 5400000.75 300.125\n";
    let cloud = cloud("map.xyz", text).unwrap();
    assert_eq!(cloud.origin, [500_000.0, 5_400_000.0, 300.0]);
    assert_eq!(cloud.points, [[0.125, 0.5, 0.0625], [0.25, 0.5, 0.0625], [0.125, 0.75, 0.125]]);
    assert!(cloud.notes[0].contains("was subtracted"), "{:?}", cloud.notes);
}

#[test]
fn pcd_binary_passes_over_padding() {
    let header = pcd_header("x y z _", 2, "binary").replace("COUNT 1 1 1 1", "COUNT 1 1 1 2");
    let mut content = header.into_bytes();
    content
        .extend([1.0_f32, 2.0, 3.0, 9.0, 9.0, 4.0, 5.0, 6.0, 9.0, 9.0].iter().flat_map(|x| x.to_le_bytes()));
    assert_eq!(cloud("scan.pcd", content).unwrap().points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]]);
}

#[test]
fn ply_reads_doubles_and_makes_normals_unit() {
    let cloud = cloud("scan.ply", PLY_CLOUD).unwrap();
    assert_eq!(cloud.points, [[1.0, 2.0, 3.0], [-1.0, 0.5, 1.0], [1e-3, 2.0, 3.0]]);
    assert_eq!(cloud.normals, Some(vec![[0.0, 0.0, 1.0], [0.0, 0.0, 1.0], [0.0; 3]]));
    let notes = ["1 of 3 normals are zero.", "1 of 3 normals were not of unit length and were renormalised."];
    assert_eq!(cloud.notes, notes);
}

#[test]
fn ply_reads_binary_of_both_byte_orders() {
    let header = |order: &str| {
        let columns =
            ["x", "y", "z", "nx", "ny", "nz"].map(|name| format!("property double {name}\n")).concat();
        format!("ply\nformat binary_{order}_endian 1.0\nelement vertex 1\n{columns}end_header\n").into_bytes()
    };
    let numbers = [1.0_f64, 2.0, 3.0, 0.0, 0.6, 0.8];
    let mut little = header("little");
    little.extend(numbers.iter().flat_map(|x| x.to_le_bytes()));
    let mut big = header("big");
    big.extend(numbers.iter().flat_map(|x| x.to_be_bytes()));
    for content in [little, big] {
        let cloud = cloud("scan.ply", content).unwrap();
        assert_eq!(cloud.points, [[1.0, 2.0, 3.0]]);
        assert_eq!(cloud.normals, Some(vec![[0.0, 0.6, 0.8]]));
    }
}

#[test]
fn xyz_takes_comments_separators_and_a_count() {
    let cloud = cloud("scan.pts", XYZ).unwrap();
    assert_eq!(cloud.points, [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]]);
    assert_eq!(cloud.normals, Some(vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]]));
    assert!(cloud.notes.is_empty());
}

#[test]
fn xyz_distinguishes_colours_from_normals() {
    let cloud = |content: &str| cloud("scan.xyz", content).unwrap();
    let colours = cloud("1 2 3 255 128 0\n4 5 6 1 0 0\n");
    assert_eq!((colours.points.len(), colours.normals), (2, None));
    assert_eq!(colours.notes, ["Columns 4 to 6 look like intensity or colour and were ignored."]);
    assert_eq!(cloud("2\n1 2 3 -1200 255 128 0\n4 5 6 7 0 0 0\n").normals, None);
    let zero = cloud("1 2 3 0.0 0.0 0.0\n");
    assert_eq!(zero.normals, None);
    assert_eq!(
        cloud("1\n1 2 3\n4 5 6\n").notes,
        ["The file begins with a count of 1 points, but 2 were found."]
    );
}

#[test]
fn an_obj_without_faces_is_a_cloud() {
    assert_eq!(cloud("scan.obj", "v 1 2 0\nv 3 4 0\nv 5 6 0\n").unwrap().points, SEEN);
}
