-- GET and PUT by other names.
return {
  added = {
    fetch = function(target, steps, shipped) shipped.get(target) end,
    bring = function(target, steps, shipped) shipped.put(target) end,
  },
}
