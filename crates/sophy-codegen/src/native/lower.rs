//! One program → one function of machine code, through Cranelift.

use super::functions::OfColumn;
use super::thunks::Thunks;
use super::trace::{Operation, Trace, trace};
use cranelift_codegen::ir::condcodes::FloatCC;
use cranelift_codegen::ir::{Block, Function, InstBuilder, MemFlagsData, Type, Value, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext, Variable};
use cranelift_jit::JITModule;
use cranelift_module::{Module, ModuleError};
use rustc_hash::{FxHashMap, FxHashSet};
use sophy_field::{Code, Instruction, NOW, Program};

/// What is asked of a function: coefficients of jets, and which numbers its callers read afterwards.
pub(super) struct Wanted<'a> {
    pub(super) program: &'a Program,
    pub(super) orders: usize,
    /// Offsets of results among the temporaries.
    pub(super) results: &'a FxHashSet<u32>,
    /// First temporary: what is written below stays.
    pub(super) temporaries: u32,
    /// How many operands each call brings.
    pub(super) operands: u32,
}

type Lowered<R> = Result<R, Box<ModuleError>>;

/// Writes the body of `function`, whose signature is that of [`sophy_field::Kernel`].
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
    let [operands, copy, memory] = [0, 1, 2].map(|k| builder.block_params(entry)[k]);
    let mut writer = Writer {
        wanted,
        builder,
        module,
        thunks,
        memory,
        pointers: Vec::new(),
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
    /// Where each operand stands.
    pointers: Vec<Value>,
    /// Numbers that the program writes, by offset.
    variables: FxHashMap<u32, Variable>,
    /// Numbers that it only reads, by offset, as loaded in the present block.
    loaded: FxHashMap<u32, Value>,
}

/// Inside of memory and of the operands nothing traps, and addresses are multiples of 8 or 4.
const TRUSTED: MemFlagsData = MemFlagsData::trusted();

impl Writer<'_> {
    fn orders(&self) -> u32 {
        self.wanted.orders as u32
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
            let pointer = self.builder.ins().iadd(self.memory, bytes);
            self.pointers.push(pointer);
            let first = self.wanted.program.gather + k * self.wanted.program.stride;
            for at in first..first + self.orders() {
                if self.wanted.results.contains(&at) {
                    let value = self.read(at);
                    self.store(at, value);
                }
            }
        }
    }

    fn declare(&mut self) {
        for instruction in &self.wanted.program.instructions {
            for at in written(instruction, self.orders()) {
                self.variables.entry(at).or_insert_with(|| self.builder.declare_var(types::F64));
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
                    let condition = self.read(instruction.a);
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
        let Trace { operations, results } = trace(instruction, self.wanted.orders);
        let needed = needed(&operations, &results);
        let mut values: Vec<Option<Value>> = Vec::with_capacity(operations.len());
        for (operation, needed) in operations.iter().zip(needed) {
            values.push(if needed { Some(self.operation(operation, instruction, &values)?) } else { None });
        }
        for (k, &result) in results.iter().enumerate() {
            if let Some(value) = values[result as usize] {
                self.write(instruction.to + k as u32, value);
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

    /// A number of what an instruction reads, as its trace counts them.
    fn input(&mut self, instruction: &Instruction, k: u32) -> Value {
        let Instruction { code, a, b, .. } = *instruction;
        match code {
            Code::Follow | Code::FollowOperand if k > b => self.read(NOW as u32),
            Code::Follow => self.read(a + k),
            Code::FollowOperand => self.load(types::F64, self.pointers[a as usize], 8 * k),
            _ if k < self.orders() => self.read(a + k),
            _ => self.read(b + k - self.orders()),
        }
    }

    fn call(&mut self, name: &'static str, arguments: &[(Type, Value)]) -> Lowered<Value> {
        let (kinds, values): (Vec<Type>, Vec<Value>) = arguments.iter().copied().unzip();
        let thunk = self.thunks.reference(name, &kinds, self.module, self.builder.func)?;
        let call = self.builder.ins().call(thunk, &values);
        Ok(self.builder.inst_results(call)[0])
    }

    fn of_column(&mut self, function: OfColumn, instruction: &Instruction) -> Lowered<()> {
        let x = self.read(instruction.a);
        let column = self.builder.ins().iadd_imm_u(self.memory, i64::from(instruction.b) * 8);
        let value = self.call(function.symbol().0, &[(types::I64, column), (types::F64, x)])?;
        self.write(instruction.to, value);
        Ok(())
    }

    /// A jet into the operand of a number.
    fn scatter(&mut self, instruction: &Instruction) {
        for k in 0..self.orders() {
            let value = self.read(instruction.a + k);
            let pointer = self.pointers[instruction.to as usize];
            self.builder.ins().store(TRUSTED, value, pointer, 8 * k as i32);
        }
    }

    fn read(&mut self, at: u32) -> Value {
        if let Some(&variable) = self.variables.get(&at) {
            return self.builder.use_var(variable);
        }
        if let Some(&value) = self.loaded.get(&at) {
            return value;
        }
        let program = self.wanted.program;
        let behind = at.wrapping_sub(program.gather);
        let value = if at >= program.gather && behind < self.wanted.operands * program.stride {
            let pointer = self.pointers[(behind / program.stride) as usize];
            self.load(types::F64, pointer, 8 * (behind % program.stride))
        } else {
            self.load(types::F64, self.memory, 8 * at)
        };
        self.loaded.insert(at, value);
        value
    }

    fn write(&mut self, at: u32, value: Value) {
        if let Some(&variable) = self.variables.get(&at) {
            self.builder.def_var(variable, value);
        }
        if at < self.wanted.temporaries || self.wanted.results.contains(&at) {
            self.store(at, value);
        }
    }

    fn load(&mut self, kind: Type, from: Value, bytes: u32) -> Value {
        self.builder.ins().load(kind, TRUSTED, from, bytes as i32)
    }

    fn store(&mut self, at: u32, value: Value) {
        self.builder.ins().store(TRUSTED, value, self.memory, 8 * at as i32);
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
