# Instruction sets that Highway does not compile the kernels for. SSSE3 gains nothing for doubles over SSE4; vectors of
# unknown length (SVE, RISC-V) cannot be members of structs, as the kernels' values are.
set(MESHORDER_SIMD_TARGETS HWY_DISABLED_TARGETS=\(HWY_SSSE3|HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV\))
