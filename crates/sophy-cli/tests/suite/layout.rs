//! `sophy fmt`: files in the canonical layout.

use crate::support::Folder;
use std::io::Write;
use std::process::Stdio;

const UNTIDY: &str = "CTC A is\nbody\n declarations state x:=1; end declarations; % one\n dynamics der(x)=-x; end dynamics;\nend body;\n";

#[test]
fn files_are_laid_out_in_place_and_said_to_be() {
    let folder = Folder::new("layout");
    folder.write("a.hsml", UNTIDY);
    folder.write("broken.hsml", "CTC A is\nbody\n  dynamics\n    der(x) = (1;\n  end dynamics;\nend body;\n");
    let check = folder.sophy(&["fmt", "--check", "a.hsml"]);
    check.ends(1, &["a.hsml: lines 3 to 4 would change"]);
    assert_eq!(folder.read("a.hsml"), UNTIDY);
    folder.sophy(&["fmt", "a.hsml"]).ends(0, &["a.hsml: lines 3 to 4 changed"]);
    let tidy = folder.read("a.hsml");
    assert!(tidy.contains("    state x := 1;\n") && tidy.contains("% one"), "{tidy}");
    folder.sophy(&["fmt", "a.hsml", "--check"]).ends(0, &["a.hsml: is laid out"]);
    // Other files are laid out though one has mistakes, which stays as it is.
    let before = folder.read("broken.hsml");
    folder.write("a.hsml", UNTIDY);
    folder.sophy(&["fmt", "broken.hsml", "a.hsml"]).ends(1, &["HS0005", "left as it is", "a.hsml: lines"]);
    assert_eq!((folder.read("broken.hsml"), folder.read("a.hsml")), (before, tidy));
    // No draft is left behind.
    assert_eq!(std::fs::read_dir(&folder.0).expect("a folder").count(), 2);
}

#[test]
fn what_is_no_hsml_or_cannot_be_read_is_said() {
    let folder = Folder::with_oscillator("layout_wrong");
    folder.sophy(&["fmt", "oscillator.xml"]).ends(2, &["no file of HSML", "sophy convert"]);
    folder.sophy(&["fmt", "missing.hsml"]).ends(4, &["cannot read missing.hsml"]);
    folder.write("latin.hsml", "");
    std::fs::write(folder.0.join("latin.hsml"), b"% Gr\xf6\xdfe\n").expect("written");
    folder.sophy(&["fmt", "latin.hsml"]).ends(1, &["HS0082", "left as it is"]);
    folder.sophy(&["fmt"]).ends(2, &["<FILE>"]);
}

#[cfg(unix)]
#[test]
fn permissions_and_links_stay() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new("layout_permissions");
    folder.write("a.hsml", UNTIDY);
    let path = folder.0.join("a.hsml");
    std::fs::set_permissions(&path, std::fs::Permissions::from_mode(0o640)).expect("set");
    std::os::unix::fs::symlink("a.hsml", folder.0.join("link.hsml")).expect("a link");
    folder.sophy(&["fmt", "link.hsml"]).ends(0, &["changed"]);
    let kind = std::fs::symlink_metadata(folder.0.join("link.hsml")).expect("there").file_type();
    assert!(kind.is_symlink());
    assert_eq!(std::fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o640);
    assert_ne!(folder.read("a.hsml"), UNTIDY);
}

#[test]
fn stdin_goes_to_stdout() {
    let folder = Folder::new("layout_stdin");
    let run = |arguments: &[&str], text: &str| {
        let mut command = folder.command(arguments);
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn().expect("starts");
        child.stdin.take().expect("piped").write_all(text.as_bytes()).expect("written");
        let output = child.wait_with_output().expect("ends");
        (output.status.code(), String::from_utf8(output.stdout).expect("text"))
    };
    let (code, tidy) = run(&["fmt", "-"], UNTIDY);
    assert_eq!(code, Some(0));
    assert!(tidy.contains("    state x := 1;\n") && tidy.ends_with("end body;\n"), "{tidy}");
    assert_eq!(run(&["fmt", "-"], &tidy), (Some(0), tidy.clone()));
    assert_eq!(run(&["fmt", "--check", "-"], UNTIDY), (Some(1), String::new()));
    assert_eq!(run(&["fmt", "-"], "CTC A is body dynamics der(x) = (1; end"), (Some(1), String::new()));
    let (_, json) = run(&["fmt", "-", "--format", "json"], UNTIDY);
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!((&value["changes"], value["text"].as_str()), (&true.into(), Some(tidy.as_str())));
}
