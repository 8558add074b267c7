use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// An oscillator that runs for ever.
pub(crate) const OSCILLATOR: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE SophySystem SYSTEM "SophySystem.dtd">
<SophySystem>
  <name>Oscillator</name>
  <hints>
    <hint hintname="initial x">1</hint>
    <hint hintname="initial v">0</hint>
  </hints>
  <constants><constant symbol="stiffness">1</constant></constants>
  <states><state>x</state><state>v</state></states>
  <inputs></inputs>
  <outputs></outputs>
  <locations>
    <location>
      <name>Right</name>
      <diffequation state="x">v</diffequation>
      <diffequation state="v">-stiffness*x</diffequation>
      <transitions>
        <transition>
          <name>to the left</name>
          <domain>x &lt; 0</domain>
          <reset><destination>Left</destination></reset>
        </transition>
      </transitions>
    </location>
    <location>
      <name>Left</name>
      <diffequation state="x">v</diffequation>
      <diffequation state="v">-stiffness*x</diffequation>
      <transitions>
        <transition>
          <name>to the right</name>
          <domain>x &gt; 0</domain>
          <reset><destination>Right</destination></reset>
        </transition>
      </transitions>
    </location>
  </locations>
</SophySystem>
"#;

/// A folder of one test, empty at its start.
pub(crate) struct Folder(pub(crate) PathBuf);

impl Folder {
    pub(crate) fn new(name: &str) -> Self {
        let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
        let _ = std::fs::remove_dir_all(&path);
        std::fs::create_dir_all(&path).expect("folder");
        Folder(path)
    }

    /// A folder with the oscillator in it.
    pub(crate) fn with_oscillator(name: &str) -> Self {
        let folder = Folder::new(name);
        folder.write("oscillator.xml", OSCILLATOR);
        folder
    }

    pub(crate) fn write(&self, name: &str, text: &str) {
        std::fs::write(self.0.join(name), text).expect("written");
    }

    pub(crate) fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.0.join(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    pub(crate) fn has(&self, name: &str) -> bool {
        self.0.join(name).exists()
    }

    /// The command, to be run in this folder.
    pub(crate) fn command(&self, arguments: &[&str]) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_sophy"));
        command.args(arguments).current_dir(&self.0).env_remove("NO_COLOR");
        command
    }

    pub(crate) fn sophy(&self, arguments: &[&str]) -> Answer {
        let Output { status, stdout, stderr } = self.command(arguments).output().expect("runs");
        Answer {
            code: status.code(),
            out: String::from_utf8(stdout).expect("text"),
            err: String::from_utf8(stderr).expect("text"),
        }
    }
}

/// What the command answered.
#[derive(Debug)]
pub(crate) struct Answer {
    pub(crate) code: Option<i32>,
    pub(crate) out: String,
    pub(crate) err: String,
}

impl Answer {
    /// Checks the exit code and that each text was said on stderr.
    #[track_caller]
    pub(crate) fn ends(&self, code: i32, said: &[&str]) -> &Self {
        assert_eq!(self.code, Some(code), "{self:#?}");
        for text in said {
            assert!(self.err.contains(text), "{text:?} was not said:\n{}", self.err);
        }
        self
    }
}
