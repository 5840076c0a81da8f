// The first argument of a call of prctl that marks the end of a stage: "hang".
enum { MARK = 0x68616e67 };
