#pragma once

namespace eg {

/// From now on Ctrl-C and kill only ask: interrupted() turns true, and a second signal ends the program at once.
void catch_interrupts();
bool interrupted();

}  // namespace eg
