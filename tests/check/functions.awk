# Makes findings of pmccabe's lines: ways through a function, of them with each case of a switch counted, statements, first
# line, lines, and FILE(LINE): NAME. Anything else it writes is a complaint.

split($6, at, /[():]+/) != 3 {
    print
    failed = 1
    next
}
$2 > 10 {
    print at[1] ":" at[2] ":1: warning:" at[3] ": " $2 " ways through it, of 10 [complexity]"
}
$5 > 60 {
    print at[1] ":" at[2] ":1: warning:" at[3] ": " $5 " lines, of 60 [length]"
}
END {
    exit failed
}
