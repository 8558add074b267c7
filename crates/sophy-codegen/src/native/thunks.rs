//! One local function per imported one: a call by absolute address from thousands of places is slow.

use super::functions::{Function, FunctionOfTwo, OfColumn, Symbol};
use cranelift_codegen::Context;
use cranelift_codegen::ir::{self, AbiParam, FuncRef, InstBuilder, types};
use cranelift_frontend::{FunctionBuilder, FunctionBuilderContext};
use cranelift_jit::JITModule;
use cranelift_module::{FuncId, Linkage, Module, ModuleError};
use rustc_hash::FxHashMap;

/// All that native code may call, for the linker.
pub(super) fn symbols() -> impl Iterator<Item = Symbol> {
    let one = Function::ALL.into_iter().map(Function::symbol);
    let two = FunctionOfTwo::ALL.into_iter().map(FunctionOfTwo::symbol);
    one.chain(two).chain(OfColumn::ALL.into_iter().map(OfColumn::symbol))
}

/// The thunks of a module that are in use.
#[derive(Default)]
pub(super) struct Thunks {
    of: FxHashMap<&'static str, (FuncId, ir::Signature)>,
    /// Those that the function being written has referred to.
    known: FxHashMap<&'static str, FuncRef>,
}

impl Thunks {
    /// A function begins.
    pub(super) fn begin(&mut self) {
        self.known.clear();
    }

    /// What to call for `name`, with these types of arguments.
    pub(super) fn reference(
        &mut self,
        name: &'static str,
        arguments: &[ir::Type],
        module: &mut JITModule,
        function: &mut ir::Function,
    ) -> Result<FuncRef, Box<ModuleError>> {
        if let Some(&known) = self.known.get(name) {
            return Ok(known);
        }
        if !self.of.contains_key(name) {
            let mut signature = module.make_signature();
            signature.params.extend(arguments.iter().map(|&kind| AbiParam::new(kind)));
            signature.returns.push(AbiParam::new(types::F64));
            self.of.insert(name, (module.declare_anonymous_function(&signature)?, signature));
        }
        let reference = module.declare_func_in_func(self.of[name].0, function);
        self.known.insert(name, reference);
        Ok(reference)
    }

    /// Writes them all.
    pub(super) fn define(
        &self,
        module: &mut JITModule,
        context: &mut Context,
        builder: &mut FunctionBuilderContext,
    ) -> Result<(), Box<ModuleError>> {
        let target = module.target_config();
        for (name, (thunk, signature)) in &self.of {
            let imported = module.declare_function(name, Linkage::Import, signature)?;
            context.func.signature = signature.clone();
            let imported = module.declare_func_in_func(imported, &mut context.func);
            let mut body = FunctionBuilder::new(&mut context.func, builder);
            let block = body.create_block();
            body.append_block_params_for_function_params(block);
            body.switch_to_block(block);
            let arguments = body.block_params(block).to_vec();
            let call = body.ins().call(imported, &arguments);
            let results = body.inst_results(call).to_vec();
            body.ins().return_(&results);
            body.seal_all_blocks();
            body.finalize(target);
            module.define_function(*thunk, context)?;
            module.clear_context(context);
        }
        Ok(())
    }
}
