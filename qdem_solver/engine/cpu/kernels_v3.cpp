#define QDEM_KERNELS kernels_v3
#define QDEM_KERNEL_WIDTH 4
#define QDEM_INSTRUCTION_SET "x86-64-v3"
#include "qdem_solver/engine/cpu/kernels_body.hpp"
