//! Models that no example has: stiff, without any damping, and with a state much smaller than its unit.

pub(crate) const STIFF_PAIR: &str = "CTC StiffPair is
body
  declarations
    state x1 := 0;
    state x2 := 20;
  end declarations;
  dynamics
    der(x1) = 0.01*x2;
    der(x2) = 2020 - 100*(x1 + x2);
  end dynamics;
end body;
end StiffPair;
";

pub(crate) const UNDAMPED: &str = "CTC Undamped is
body
  declarations
    state x := 1;
    state v := 0;
  end declarations;
  dynamics
    der(x) = v;
    der(v) = -x;
  end dynamics;
end body;
end Undamped;
";

/// A current of a nanoampere charges a fifth of a nanofarad.
pub(crate) const NANOAMPERE: &str = "CTC Nanoampere is
body
  declarations
    state i := 0 \"A\";
    state u := 0 \"V\";
  end declarations;
  dynamics
    der(i) = (i_end - i)/T;
    der(u) = i/C;
  end dynamics;
  assignments
    i_end : 1e-9 \"A\";
    T : 1 \"s\";
    C : 2e-10 \"F\";
  end assignments;
end body;
end Nanoampere;
";
