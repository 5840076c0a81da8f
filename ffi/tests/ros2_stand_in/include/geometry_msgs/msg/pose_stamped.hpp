#include "../../../messages.hpp"
