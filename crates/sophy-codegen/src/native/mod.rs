//! Programs as machine code, made at run time by Cranelift.
//!
//! The arithmetic is the interpreter's own, traced instruction by instruction ([`trace`]), so that both give the
//! same bits. A program becomes one function for each number of coefficients that is asked of it ([`lower`]); a
//! shared program serves all its calls.

#![allow(unsafe_code)]

mod functions;
mod lower;
#[cfg(test)]
mod tests;
mod thunks;
mod trace;

use cranelift_codegen::ir::{AbiParam, types};
use cranelift_codegen::settings::{self, Configurable};
use cranelift_frontend::FunctionBuilderContext;
use cranelift_jit::{JITBuilder, JITModule};
use cranelift_module::{FuncId, Module, ModuleError, default_libcall_names};
use lower::{Kind, Wanted, lower};
use rustc_hash::FxHashSet;
use sophy_field::{Affine, BoundKernel, Call, Equations, Formula, Kernel, Kernels, Logic, Program};
use std::sync::{Arc, Mutex};
use thunks::{Thunks, symbols};

/// Programs with more instructions stay interpreted: a function takes time that grows faster than its length.
const LONGEST: usize = 2000;
/// The same of programs over balls, which do some ten times as much.
const LONGEST_BOUND: usize = 200;

/// There is no native code on this machine.
#[derive(Debug, thiserror::Error)]
pub enum NoNativeCode {
    /// No code generator for this processor.
    #[error("no native code for this processor: {0}")]
    Processor(&'static str),
    /// Executable memory was refused, or the code generator failed.
    #[error("native code cannot be made: {0}")]
    Module(#[from] Box<ModuleError>),
    /// Memory is too large to be addressed.
    #[error("the model is too large for native code")]
    TooLarge,
}

/// What keeps the machine code alive; it is never freed while a kernel can be called.
struct Code(Mutex<Option<JITModule>>);

impl Drop for Code {
    fn drop(&mut self) {
        let module = self.0.get_mut().map(Option::take).unwrap_or_default();
        if let Some(module) = module {
            // SAFETY: `Kernels` hold this as long as one of their functions can be called.
            unsafe { module.free_memory() };
        }
    }
}

/// Machine code for the programs of `equations` and `logic`.
///
/// # Errors
/// [`NoNativeCode`]: then everything is interpreted, with the same bits.
pub fn native(equations: &Equations, logic: &Logic) -> Result<Kernels, NoNativeCode> {
    if i32::try_from(u64::from(equations.layout.length) * 8).is_err() {
        return Err(NoNativeCode::TooLarge);
    }
    // SAFETY: these are all calls of these programs, and programs stay inside operands and memory.
    unsafe { compile(&equations.programs, equations.layout.rest, &Asked::of(equations, logic)) }
}

/// # Safety
/// Operands are so many as `asked` says; they and what the programs address lie inside of memory, and what they write
/// lies behind `rest`, where the records end.
unsafe fn compile(programs: &[Program], rest: u32, asked: &Asked) -> Result<Kernels, NoNativeCode> {
    let mut module = module()?;
    let (mut context, mut builder) = (module.make_context(), FunctionBuilderContext::new());
    let mut thunks = Thunks::default();
    let mut function = |kind: Kind, position: usize, operands: u32| -> Result<FuncId, NoNativeCode> {
        let (program, results) = (&programs[position], &asked.results[position]);
        let wanted = Wanted { program, kind, results, temporaries: program.gather, operands };
        let pointer = AbiParam::new(types::I64);
        context.func.signature.params.extend([pointer, AbiParam::new(types::I32), pointer]);
        if let Kind::Balls(_) = kind {
            context.func.signature.params.extend([pointer; 2]);
        }
        thunks.begin();
        lower(&wanted, &mut context.func, &mut builder, &mut module, &mut thunks)?;
        let function = module.declare_anonymous_function(&context.func.signature).map_err(Box::new)?;
        module.define_function(function, &mut context).map_err(Box::new)?;
        module.clear_context(&mut context);
        Ok(function)
    };
    let mut functions: Vec<[Option<FuncId>; 4]> = vec![[None; 4]; programs.len()];
    let mut bounds: Vec<Option<FuncId>> = vec![None; programs.len()];
    for (position, program) in programs.iter().enumerate() {
        let length = program.instructions.len();
        for (orders, calls) in (1..).zip(&asked.calls) {
            if let Some(operands) = calls[position].filter(|_| length <= LONGEST) {
                functions[position][orders - 1] = Some(function(Kind::Jets(orders), position, operands)?);
            }
        }
        if let Some(operands) = asked.bounds[position].filter(|_| length <= LONGEST_BOUND) {
            bounds[position] = Some(function(Kind::Balls(rest), position, operands)?);
        }
    }
    thunks.define(&mut module, &mut context, &mut builder)?;
    module.finalize_definitions().map_err(Box::new)?;
    let code = |function: FuncId| module.get_finalized_function(function);
    let kernel = |function| {
        // SAFETY: this is the code of a function of this signature.
        unsafe { std::mem::transmute::<*const u8, Kernel>(code(function)) }
    };
    let bound = |function| {
        // SAFETY: as before.
        unsafe { std::mem::transmute::<*const u8, BoundKernel>(code(function)) }
    };
    let kernels = functions.into_iter().map(|of| of.map(|function| function.map(kernel))).collect();
    let bounds = bounds.into_iter().map(|function| function.map(bound)).collect();
    // SAFETY: `lower` addresses what the interpreter does.
    Ok(unsafe { Kernels::new(kernels, bounds, Arc::new(Code(Mutex::new(Some(module))))) })
}

fn module() -> Result<JITModule, NoNativeCode> {
    let mut flags = settings::builder();
    let verify = if cfg!(debug_assertions) { "true" } else { "false" };
    for (name, value) in [
        ("use_colocated_libcalls", "false"),
        ("is_pic", "false"),
        ("opt_level", "speed"),
        ("enable_verifier", verify),
    ] {
        flags.set(name, value).map_err(|_| NoNativeCode::Processor("its settings are refused"))?;
    }
    let isa = cranelift_native::builder().map_err(NoNativeCode::Processor)?;
    let isa = isa
        .finish(settings::Flags::new(flags))
        .map_err(|_| NoNativeCode::Processor("its settings are refused"))?;
    let mut builder = JITBuilder::with_isa(isa, default_libcall_names());
    for (name, address) in symbols() {
        builder.symbol(name, address);
    }
    Ok(JITModule::new(builder))
}

/// What callers ask of each program.
struct Asked {
    /// By orders − 1, then by program: the number of operands, if it is run with so many coefficients.
    calls: Vec<Vec<Option<u32>>>,
    /// By program: the same if it is bounded.
    bounds: Vec<Option<u32>>,
    /// By program: offsets that are read when it has run.
    results: Vec<FxHashSet<u32>>,
}

impl Asked {
    fn of(equations: &Equations, logic: &Logic) -> Self {
        let (programs, width) = (equations.programs.len(), equations.layout.width as usize);
        let mut asked = Asked {
            calls: vec![vec![None; programs]; width],
            bounds: vec![None; programs],
            results: vec![FxHashSet::default(); programs],
        };
        let searched = || equations.watch_codes.iter().filter(|watch| !watch.affine);
        if searched().next().is_some() {
            let formulas = searched().map(|watch| &watch.formula.call);
            for call in equations.calls.iter().chain(formulas) {
                asked.bounds[call.program as usize] = Some(call.operands.len() as u32);
            }
        }
        for block in &equations.blocks {
            let orders = if block.bends { width } else { width - 1 };
            asked.call(&block.call, &[1, orders]);
            // For motions of one state alone, and at starts of the third order.
            if width != 3 {
                asked.call(&block.call, &[2]);
            }
            for row in &block.rows {
                asked.result(&block.call, row.at, row.is_jet, width);
            }
        }
        for call in &equations.calls {
            asked.call(call, &[1, width]);
        }
        for watch in &equations.watch_codes {
            asked.formula(&watch.formula, &[1, width], width);
            asked.formula(&watch.left, &[1], width);
            asked.formula(&watch.right, &[1], width);
        }
        let resets = logic.transition_codes.iter().flat_map(|transition| {
            let resets = transition.resets.iter().map(|(_, formula)| formula);
            resets.chain(transition.emits.iter().filter_map(|emission| emission.when.as_ref()))
        });
        for formula in equations.formulas.iter().chain(resets) {
            asked.formula(formula, &[1], width);
        }
        asked
    }

    fn formula(&mut self, formula: &Formula, orders: &[usize], width: usize) {
        self.call(&formula.call, orders);
        self.result(&formula.call, formula.at, formula.is_jet, width);
    }

    fn call(&mut self, call: &Call, orders: &[usize]) {
        for &orders in orders {
            self.calls[orders - 1][call.program as usize] = Some(call.operands.len() as u32);
        }
    }

    fn result(&mut self, call: &Call, at: Affine, is_jet: bool, width: usize) {
        // What is computed stands among the temporaries, the same for all copies.
        let count = if is_jet { width as u32 } else { 1 };
        self.results[call.program as usize].extend(at.first..at.first + count);
    }
}
