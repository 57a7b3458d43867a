# Turns pmccabe's lines into findings. Its columns are: paths through a function, the same with each case of a switch counted,
# statements, first line, lines, and FILE(LINE): NAME. Any other line from pmccabe is a complaint.

# In C++ the names of namespaces and types stand before the function's name.
split($6, at, /[():]+/) < 3 {
    print
    failed = 1
    next
}
{
    name = substr($6, index($6, "): ") + 2)
}
$2 > 10 {
    print at[1] ":" at[2] ":1: warning:" name ": " $2 " ways through it, of 10 [complexity]"
}
$5 > 60 {
    print at[1] ":" at[2] ":1: warning:" name ": " $5 " lines, of 60 [length]"
}
END {
    exit failed
}
