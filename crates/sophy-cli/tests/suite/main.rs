//! The `sophy` command as a user meets it: exit codes, messages, files.

#![allow(clippy::expect_used, clippy::panic, reason = "a test stops at the first surprise")]

#[cfg(unix)]
mod endings;
mod explain;
mod languages;
mod layout;
mod info;
mod messages;
mod results;
mod support;
mod templates;
