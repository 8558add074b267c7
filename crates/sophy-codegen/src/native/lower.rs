//! One program → one function of machine code, through Cranelift.

use super::functions::OfColumn;
use super::thunks::Thunks;
use super::trace::{Operation, Trace};
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{Block, Function, InstBuilder, MemFlagsData, Type, Value, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Variable};
use cranelift_jit::JITModule;
use cranelift_module::{Module, ModuleError};
use rustc_hash::{FxHashMap, FxHashSet};
use sophy_field::{Code, Instruction, NOW, Program};

/// What is asked of a function: of what kind its arithmetic is, and which results its callers read afterwards.
pub(super) struct Wanted<'a> {
    pub(super) program: &'a Program,
    pub(super) kind: Kind,
    /// Offsets of results among the temporaries.
    pub(super) results: &'a FxHashSet<u32>,
    /// First temporary: what is written below stays.
    pub(super) temporaries: u32,
    /// How many operands each call brings.
    pub(super) operands: u32,
}

/// What is computed.
#[derive(Clone, Copy, Debug)]
pub(super) enum Kind {
    /// Jets of so many coefficients, by a [`sophy_field::Kernel`].
    Jets(usize),
    /// Balls, by a [`sophy_field::BoundKernel`]; they stand for what follows this offset.
    Balls(u32),
}

impl Kind {
    /// Coefficients of a jet.
    fn orders(self) -> u32 {
        match self {
            Kind::Jets(orders) => orders as u32,
            Kind::Balls(_) => 1,
        }
    }

    /// Numbers that make up a coefficient or a scalar.
    fn parts(self) -> u32 {
        match self {
            Kind::Jets(_) => 1,
            Kind::Balls(_) => 2,
        }
    }
}

type Lowered<R> = Result<R, Box<ModuleError>>;

/// Writes the body of `function`, whose signature is that of the kernels of its kind.
pub(super) fn lower(
    wanted: &Wanted<'_>,
    function: &mut Function,
    context: &mut FunctionBuilderContext,
    module: &mut JITModule,
    thunks: &mut Thunks,
) -> Lowered<()> {
    let target = module.target_config();
    let mut builder = FunctionBuilder::new(function, context);
    let entry = builder.create_block();
    builder.append_block_params_for_function_params(entry);
    builder.switch_to_block(entry);
    let parameters = builder.block_params(entry).to_vec();
    let (operands, copy, memory) = (parameters[0], parameters[1], parameters[2]);
    let (enclosed, now) = match wanted.kind {
        Kind::Jets(_) => (memory, memory),
        Kind::Balls(_) => (parameters[3], parameters[4]),
    };
    let mut writer = Writer {
        wanted,
        builder,
        module,
        thunks,
        memory,
        enclosed,
        now,
        records: Vec::new(),
        cells: Vec::new(),
        variables: FxHashMap::default(),
        loaded: FxHashMap::default(),
    };
    writer.gather(operands, copy);
    writer.declare();
    writer.body()?;
    writer.builder.seal_all_blocks();
    writer.builder.finalize(target);
    Ok(())
}

struct Writer<'a> {
    wanted: &'a Wanted<'a>,
    builder: FunctionBuilder<'a>,
    module: &'a mut JITModule,
    thunks: &'a mut Thunks,
    memory: Value,
    /// Where balls stand, and the present time; memory, if there are none.
    enclosed: Value,
    now: Value,
    /// Where each operand stands if it is a record, and if it is none.
    records: Vec<Value>,
    cells: Vec<Value>,
    /// What the program writes, by offset and part.
    variables: FxHashMap<(u32, u32), Variable>,
    /// What it only reads, as loaded in the present block.
    loaded: FxHashMap<(u32, u32), Value>,
}

/// Inside of memory and of the operands nothing traps, and addresses are multiples of 8 or 4.
const TRUSTED: MemFlagsData = MemFlagsData::trusted();

impl Writer<'_> {
    fn orders(&self) -> u32 {
        self.wanted.kind.orders()
    }

    fn parts(&self) -> u32 {
        self.wanted.kind.parts()
    }

    /// The addresses of operands; results among them are copied to where they are expected.
    fn gather(&mut self, operands: Value, copy: Value) {
        for k in 0..self.wanted.operands {
            let first = self.load(types::I32, operands, 8 * k);
            let stride = self.load(types::I32, operands, 8 * k + 4);
            let distance = self.builder.ins().imul(stride, copy);
            let offset = self.builder.ins().iadd(first, distance);
            let offset = self.builder.ins().uextend(types::I64, offset);
            let bytes = self.builder.ins().ishl_imm_u(offset, 3);
            let record = self.builder.ins().iadd(self.memory, bytes);
            let cell = match self.wanted.kind {
                Kind::Jets(_) => record,
                Kind::Balls(rest) => {
                    let behind = self.builder.ins().iadd_imm_s(offset, -i64::from(rest));
                    let bytes = self.builder.ins().ishl_imm_u(behind, 4);
                    self.builder.ins().iadd(self.enclosed, bytes)
                }
            };
            self.records.push(record);
            self.cells.push(cell);
            let first = self.wanted.program.gather + k * self.wanted.program.stride;
            for at in first..first + self.orders() {
                if self.wanted.results.contains(&at) {
                    for part in 0..self.parts() {
                        let value = self.read(at, part);
                        self.store(at, part, value);
                    }
                }
            }
        }
    }

    fn declare(&mut self) {
        for instruction in &self.wanted.program.instructions {
            for at in written(instruction, self.orders()) {
                for part in 0..self.parts() {
                    let declare = || self.builder.declare_var(types::F64);
                    self.variables.entry((at, part)).or_insert_with(declare);
                }
            }
        }
    }

    fn body(&mut self) -> Lowered<()> {
        let program = self.wanted.program;
        let mut labels: FxHashMap<u32, Block> = FxHashMap::default();
        for instruction in &program.instructions {
            if matches!(instruction.code, Code::Jump | Code::JumpIfZero) {
                labels.entry(instruction.b).or_insert_with(|| self.builder.create_block());
            }
        }
        // Whether the block before ended with a jump.
        let mut ended = false;
        for (position, instruction) in program.instructions.iter().enumerate() {
            if let Some(&block) = labels.get(&(position as u32)) {
                self.continue_in(block, ended);
                ended = false;
            }
            match instruction.code {
                Code::Jump => {
                    self.builder.ins().jump(labels[&instruction.b], &[]);
                    ended = true;
                }
                Code::JumpIfZero => {
                    let condition = self.read(instruction.a, 0);
                    let zero = self.builder.ins().f64const(0.0);
                    let is_zero = self.builder.ins().fcmp(FloatCC::Equal, condition, zero);
                    let next = self.builder.create_block();
                    self.builder.ins().brif(is_zero, labels[&instruction.b], &[], next, &[]);
                    self.builder.switch_to_block(next);
                    self.loaded.clear();
                }
                Code::Store => self.scatter(instruction),
                Code::Locate => self.of_column(OfColumn::Locate, instruction)?,
                Code::Lookup => self.of_column(OfColumn::Lookup, instruction)?,
                _ => self.compute(instruction)?,
            }
        }
        if let Some(&block) = labels.get(&(program.instructions.len() as u32)) {
            self.continue_in(block, ended);
        }
        self.builder.ins().return_(&[]);
        Ok(())
    }

    fn continue_in(&mut self, block: Block, ended: bool) {
        if !ended {
            self.builder.ins().jump(block, &[]);
        }
        self.builder.switch_to_block(block);
        self.loaded.clear();
    }

    /// An instruction of arithmetic.
    fn compute(&mut self, instruction: &Instruction) -> Lowered<()> {
        let Trace { operations, results } = match self.wanted.kind {
            Kind::Jets(orders) => Trace::of(instruction, orders),
            Kind::Balls(_) => Trace::of_balls(instruction),
        };
        let needed = needed(&operations, &results);
        let mut values: Vec<Option<Value>> = Vec::with_capacity(operations.len());
        for (operation, needed) in operations.iter().zip(needed) {
            values.push(if needed { Some(self.operation(operation, instruction, &values)?) } else { None });
        }
        for (k, &result) in (0..).zip(&results) {
            if let Some(value) = values[result as usize] {
                self.write(instruction.to + k / self.parts(), k % self.parts(), value);
            }
        }
        Ok(())
    }

    fn operation(
        &mut self,
        operation: &Operation,
        instruction: &Instruction,
        values: &[Option<Value>],
    ) -> Lowered<Value> {
        // What is needed was computed before.
        let of = |position: u32| values[position as usize].unwrap_or(self.memory);
        Ok(match *operation {
            Operation::Input(k) => self.input(instruction, k),
            Operation::Number(value) => self.builder.ins().f64const(value),
            Operation::Add(a, b) => self.builder.ins().fadd(of(a), of(b)),
            Operation::Subtract(a, b) => self.builder.ins().fsub(of(a), of(b)),
            Operation::Multiply(a, b) => self.builder.ins().fmul(of(a), of(b)),
            Operation::Divide(a, b) => self.builder.ins().fdiv(of(a), of(b)),
            Operation::Negate(a) => self.builder.ins().fneg(of(a)),
            Operation::Absolute(a) => self.builder.ins().fabs(of(a)),
            Operation::Sqrt(a) => self.builder.ins().sqrt(of(a)),
            Operation::Floor(a) => self.builder.ins().floor(of(a)),
            Operation::Less(a, b) => self.builder.ins().fcmp(FloatCC::LessThan, of(a), of(b)),
            Operation::Equal(a, b) => self.builder.ins().fcmp(FloatCC::Equal, of(a), of(b)),
            Operation::Choose(condition, a, b) => self.builder.ins().select(of(condition), of(a), of(b)),
            Operation::Call(function, a) => {
                let a = of(a);
                self.call(function.symbol().0, &[(types::F64, a)])?
            }
            Operation::CallTwo(function, a, b) => {
                let (a, b) = (of(a), of(b));
                self.call(function.symbol().0, &[(types::F64, a), (types::F64, b)])?
            }
        })
    }

    /// A part of what an instruction reads, as its trace counts them.
    fn input(&mut self, instruction: &Instruction, k: u32) -> Value {
        let Instruction { code, a, b, .. } = *instruction;
        let (k, part) = (k / self.parts(), k % self.parts());
        match code {
            Code::Follow | Code::FollowOperand if k > b => match self.wanted.kind {
                Kind::Jets(_) => self.read(NOW as u32, 0),
                Kind::Balls(_) => self.load(types::F64, self.now, 8 * part),
            },
            // Records hold numbers.
            Code::Follow | Code::FollowOperand if part > 0 => self.builder.ins().f64const(0.0),
            Code::Follow => self.read(a + k, 0),
            Code::FollowOperand => self.load(types::F64, self.records[a as usize], 8 * k),
            _ if k < self.orders() => self.read(a + k, part),
            _ => self.read(b + k - self.orders(), part),
        }
    }

    fn call(&mut self, name: &'static str, arguments: &[(Type, Value)]) -> Lowered<Value> {
        let (kinds, values): (Vec<Type>, Vec<Value>) = arguments.iter().copied().unzip();
        let thunk = self.thunks.reference(name, &kinds, self.module, self.builder.func)?;
        let call = self.builder.ins().call(thunk, &values);
        Ok(self.builder.inst_results(call)[0])
    }

    fn of_column(&mut self, function: OfColumn, instruction: &Instruction) -> Lowered<()> {
        let x = self.read(instruction.a, 0);
        let column = self.builder.ins().iadd_imm_u(self.memory, i64::from(instruction.b) * 8);
        let zero = self.builder.ins().f64const(0.0);
        let value = match (self.wanted.kind, function) {
            (Kind::Balls(_), OfColumn::Locate) => zero,
            _ => self.call(function.symbol().0, &[(types::I64, column), (types::F64, x)])?,
        };
        self.write(instruction.to, 0, value);
        if let Kind::Balls(_) = self.wanted.kind {
            // See `BallOf::radius_of_lookup`; of a position among knots nothing is known.
            let unknown = self.builder.ins().f64const(f64::INFINITY);
            let radius = match function {
                OfColumn::Locate => unknown,
                OfColumn::Lookup => {
                    let radius = self.read(instruction.a, 1);
                    let known = self.builder.ins().fcmp(FloatCC::Equal, radius, zero);
                    self.builder.ins().select(known, zero, unknown)
                }
            };
            self.write(instruction.to, 1, radius);
        }
        Ok(())
    }

    /// A jet into the operand of a number.
    fn scatter(&mut self, instruction: &Instruction) {
        let parts = self.parts();
        for (k, part) in (0..self.orders()).flat_map(|k| (0..parts).map(move |part| (k, part))) {
            let value = self.read(instruction.a + k, part);
            let cell = self.cells[instruction.to as usize];
            self.builder.ins().store(TRUSTED, value, cell, 8 * (k * parts + part) as i32);
        }
    }

    fn read(&mut self, at: u32, part: u32) -> Value {
        if let Some(&variable) = self.variables.get(&(at, part)) {
            return self.builder.use_var(variable);
        }
        if let Some(&value) = self.loaded.get(&(at, part)) {
            return value;
        }
        let (program, parts) = (self.wanted.program, self.parts());
        let behind = at.wrapping_sub(program.gather);
        let (from, bytes) = match self.wanted.kind {
            _ if at >= program.gather && behind < self.wanted.operands * program.stride => {
                let cell = self.cells[(behind / program.stride) as usize];
                (cell, 8 * (behind % program.stride * parts + part))
            }
            Kind::Balls(rest) if at < rest => (self.memory, 8 * at),
            _ => (self.enclosed, self.bytes(at, part)),
        };
        let value = self.load(types::F64, from, bytes);
        self.loaded.insert((at, part), value);
        value
    }

    fn write(&mut self, at: u32, part: u32, value: Value) {
        if let Some(&variable) = self.variables.get(&(at, part)) {
            self.builder.def_var(variable, value);
        }
        if at < self.wanted.temporaries || self.wanted.results.contains(&at) {
            self.store(at, part, value);
        }
    }

    /// How far behind `enclosed` a part stands.
    fn bytes(&self, at: u32, part: u32) -> u32 {
        match self.wanted.kind {
            Kind::Jets(_) => 8 * at,
            Kind::Balls(rest) => 16 * (at - rest) + 8 * part,
        }
    }

    fn load(&mut self, kind: Type, from: Value, bytes: u32) -> Value {
        self.builder.ins().load(kind, TRUSTED, from, bytes as i32)
    }

    fn store(&mut self, at: u32, part: u32, value: Value) {
        let bytes = self.bytes(at, part) as i32;
        self.builder.ins().store(TRUSTED, value, self.enclosed, bytes);
    }
}

/// The offsets an instruction writes.
fn written(instruction: &Instruction, orders: u32) -> std::ops::Range<u32> {
    let length = match instruction.code {
        Code::Jump | Code::JumpIfZero | Code::Store => 0,
        code if code.writes_jet() => orders,
        _ => 1,
    };
    instruction.to..instruction.to + length
}

/// Which operations the results depend on.
fn needed(operations: &[Operation], results: &[u32]) -> Vec<bool> {
    let mut needed = vec![false; operations.len()];
    for &result in results {
        needed[result as usize] = true;
    }
    for position in (0..operations.len()).rev() {
        if needed[position] {
            operations[position].operands(|operand| needed[operand as usize] = true);
        }
    }
    needed
}
