#define QDEM_KERNELS kernels_base
#define QDEM_KERNEL_WIDTH 2
#define QDEM_INSTRUCTION_SET "base"
#include "qdem_solver/engine/cpu/kernels_body.hpp"
