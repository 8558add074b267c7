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

/// Either half comes to rest alone; each moves the place where the other would.
pub(crate) const PAIR: &str = "CTC Pair is
body
  declarations
    state x1 := 0;
    state x2 := 0;
  end declarations;
  dynamics
    der(x1) = k*(0.2 - x1 - c*x2);
    der(x2) = k*(1.2 + c*x1 - x2);
  end dynamics;
  assignments
    k : 1e4;
    c : 2;
  end assignments;
end body;
end Pair;
";

pub(crate) const ROBERTSON: &str = "CTC Robertson is
body
  declarations
    state y1 := 1;
    state y2 := 0;
    state y3 := 0;
  end declarations;
  dynamics
    der(y1) = -0.04*y1 + 1e4*y2*y3;
    der(y2) = 0.04*y1 - 1e4*y2*y3 - 3e7*y2^2;
    der(y3) = 3e7*y2^2;
  end dynamics;
end body;
end Robertson;
";
