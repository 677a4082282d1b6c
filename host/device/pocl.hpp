// What has to be right in the process before PoCL is asked for its devices; other drivers do not mind.
#pragma once

namespace stokes {

// A folder that can be written for PoCL's compiled kernels, in place of its own choice where that cannot be
// made; PoCL dies with a signal without one. Warns when it stands in. RunError when there is none.
void prepare_pocl_cache();

// A name PoCL does not know in POCL_DEVICES ends the process with a signal: InputError before that.
void check_pocl_devices();

}  // namespace stokes
