#pragma once

/// How the heavy half can be compiled once instead of in every file that uses it.
///
/// Everything that computes is a template on its scalar, so that a file pays for what it uses and nothing else. Below
/// the body of what is worth compiling ahead stands one line that names the instance:
///
///   THERMFIT_COMPILED_TEMPLATE(MapFit map_fit<double>(const MachineRecord&, …));
///
/// Header-only (the default) this is nothing. With THERMFIT_COMPILED, which the target thermfit::compiled brings to
/// those who link it, the line declares the instance that the library holds; the sources of the library (src/compiled/)
/// include what lies below, empty THERMFIT_COMPILED_ELSEWHERE, and include their own headers, where the same line then
/// defines it.

#if defined(THERMFIT_COMPILED)
#define THERMFIT_COMPILED_ELSEWHERE extern
#define THERMFIT_COMPILED_TEMPLATE(...) THERMFIT_COMPILED_ELSEWHERE template __VA_ARGS__
#else
#define THERMFIT_COMPILED_TEMPLATE(...) static_assert(true, "header-only")
#endif
