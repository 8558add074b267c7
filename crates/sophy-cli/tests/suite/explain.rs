//! `sophy explain`: the pages of codes.

use crate::support::Folder;

#[test]
fn a_code_is_explained_in_any_letters() {
    let folder = Folder::new("explain");
    let page = folder.sophy(&["explain", "HS0303"]);
    page.ends(0, &[]);
    assert!(page.out.starts_with("HS0303: outputs define one another\n"), "{}", page.out);
    assert!(page.out.contains("```hsml"), "{}", page.out);
    assert_eq!(folder.sophy(&["explain", "hs0303"]).out, page.out);
    let json = folder.sophy(&["explain", "HS0303", "--format", "json"]).out;
    let value: serde_json::Value = serde_json::from_str(json.trim()).expect("JSON");
    assert_eq!((&value["code"], &value["kind"]), (&"HS0303".into(), &"page".into()));
}

#[test]
fn an_unknown_code_is_wrong_use_and_a_near_one_is_named() {
    let folder = Folder::new("explain_unknown");
    folder.sophy(&["explain", "HS033"]).ends(2, &["no code `HS033`", "did you mean `HS0"]);
    folder.sophy(&["explain", "what"]).ends(2, &["no code `what`", "lists all codes"]);
}

#[test]
fn without_a_code_all_are_listed() {
    let folder = Folder::new("explain_all");
    let list = folder.sophy(&["explain"]).out;
    assert!(list.lines().count() > 150, "{list}");
    assert!(list.lines().any(|line| line == "HS0303  outputs define one another"), "{list}");
    let json = folder.sophy(&["--format", "json", "explain"]).out;
    let value: serde_json::Value = serde_json::from_str(json.trim()).expect("JSON");
    assert_eq!(value["codes"].as_array().map(Vec::len), Some(list.lines().count()));
}
